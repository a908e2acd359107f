// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_encoder.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include <meshfarm/util/errors.hpp>

#include "srgb.hpp"

namespace meshfarm {

static_assert(std::endian::native == std::endian::little);

GltfEncoder::GltfEncoder(const std::filesystem::path& path, const MeshSinkOptions& options)
    : FileSink(path, options),
      layout_(options),
      buffer_(k_most_at_once * std::max<std::size_t>(layout_.vertex_bytes, 12)) {
  if (!options.labels && !options.uvs) return;
  // Without labels, all is one part.
  parts_.emplace(options.labels.value_or(LabelMeaning{"", {Material{}}}), options.triangles);
  kept_.emplace(layout_);
}

GltfWords GltfEncoder::words(std::string uri) {
  GltfWords made{.comment = options().comment, .uri = std::move(uri)};
  if (!parts_) return made;
  layout_.set_vertices(kept_->count());
  std::vector<GltfPart> parts = parts_->finish(path());
  if (!options().labels) return made;
  made.parts = std::move(parts);
  if (!layout_.uvs) return made;
  std::vector<const Material*> materials;
  for (const GltfPart& part : made.parts) materials.push_back(&part.material);
  made.images = find_gltf_images(materials, options().pictures, path());
  return made;
}

void GltfEncoder::write_kept(const std::function<void(std::string_view)>& to) {
  if (!kept_) return;
  kept_->write(to);
  parts_->write(layout_.index_bytes, to);
}

GltfBounds GltfEncoder::bounds() const {
  GltfBounds made{.lo = lo_, .hi = hi_};
  if (options().positions == PositionType::float64) {
    const Vec3 origin = origin_.value_or(Vec3{});
    made.translation = {origin.x, origin.y, origin.z};
  }
  return made;
}

void GltfEncoder::put(std::span<const Vec3> batch, std::span<const float> values) {
  begin_positions(batch);
  char* out = buffer_.data();
  const std::size_t channels = options().channels.size();
  for (const Vec3& p : batch) {
    out = put_position(p, out);
    if (layout_.normals) out = put_normal(values.first(channels), out);
    if (layout_.colours) out = put_colour(values.first(channels), out);
    if (layout_.uvs) out = std::fill_n(out, sizeof(Uv), '\0');  // until a triangle sets it
    values = values.subspan(channels);
  }
  write_up_to(out);
}

void GltfEncoder::put(const TriangleView& batch) {
  if (layout_.uvs) return put_split(batch);
  if (parts_) return parts_->add(batch);
  char* out = buffer_.data();
  for (const WideTriangle& triangle : batch.corners) {
    for (const std::uint64_t index : triangle) {
      std::memcpy(out, &index, layout_.index_bytes);  // its low bytes
      out += layout_.index_bytes;
    }
  }
  write_up_to(out);
}

void GltfEncoder::put_split(const TriangleView& batch) {
  split_.clear();
  for (std::size_t i = 0; i < batch.size(); ++i) {
    WideTriangle& made = split_.emplace_back();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      made[corner] = kept_->split(batch.corners[i][corner], batch.columns.uvs[i][corner]);
    }
  }
  if (kept_->count() > UINT32_MAX) {
    throw UsageError(path().string() + ": a glTF of more than 2^32 vertices cannot be written, " +
                     "and those with several texture coordinates count as several");
  }
  parts_->add({split_, {.labels = batch.columns.labels, .uvs = {}}});
}

/// Doubles are written relative to the first position, so that floats keep their digits; floats
/// unchanged. A vertex without a position, which no triangle uses, is put where another one is.
void GltfEncoder::begin_positions(std::span<const Vec3> batch) {
  if (filler_) return;
  const auto found = std::find_if(batch.begin(), batch.end(), has_position);
  if (found == batch.end()) return;
  filler_ = *found;
  if (options().positions == PositionType::float64) origin_ = *found;
}

char* GltfEncoder::put_position(Vec3 p, char* out) {
  const Vec3 shown = has_position(p) ? p : filler_.value_or(Vec3{});
  const Vec3 relative = origin_ ? shown - *origin_ : shown;
  const std::array<float, 3> xyz{static_cast<float>(relative.x), static_cast<float>(relative.y),
                                 static_cast<float>(relative.z)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(xyz[axis])) {
      throw DataError(path().string() +
                      ": glTF cannot hold a coordinate that is too large for a float");
    }
    lo_[axis] = std::min(lo_[axis], static_cast<double>(xyz[axis]));
    hi_[axis] = std::max(hi_[axis], static_cast<double>(xyz[axis]));
  }
  std::memcpy(out, xyz.data(), sizeof xyz);
  return out + sizeof xyz;
}

/// Normalised, as glTF demands; one without a length becomes (0, 0, 1).
char* GltfEncoder::put_normal(std::span<const float> of_vertex, char* out) const {
  const auto& [x, y, z] = *layout_.normals;
  Vec3 normal{of_vertex[x], of_vertex[y], of_vertex[z]};
  const double size = length(normal);
  const bool is_fit = size > 0 && std::isfinite(size);
  if (!is_fit) {
    normal = {0, 0, 1};
  } else if (std::abs(size - 1) > 1e-4) {
    normal = normal * (1 / size);
  }
  const std::array<float, 3> xyz{static_cast<float>(normal.x), static_cast<float>(normal.y),
                                 static_cast<float>(normal.z)};
  std::memcpy(out, xyz.data(), sizeof xyz);
  return out + sizeof xyz;
}

char* GltfEncoder::put_colour(std::span<const float> of_vertex, char* out) const {
  std::array<float, 4> rgba{};
  const auto level = [&](std::size_t column) {
    return static_cast<double>(colour_level(options().channels[column].type, of_vertex[column]));
  };
  for (std::size_t i = 0; i < 3; ++i) {
    rgba[i] = static_cast<float>(linear_of_srgb(level((*layout_.colours)[i])));
  }
  if (layout_.alpha) {
    const double alpha = level(*layout_.alpha);  // may be NaN in a converted mesh
    rgba[3] = alpha > 0 ? static_cast<float>(std::min(alpha, 1.0)) : 0;
  }
  if (layout_.colour_type != ChannelType::uint8) {
    std::memcpy(out, rgba.data(), layout_.colour_bytes);
    return out + layout_.colour_bytes;
  }
  std::array<std::uint16_t, 4> whole{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double linear = static_cast<double>(rgba[i]) * UINT16_MAX;
    whole[i] = static_cast<std::uint16_t>(std::floor(linear + 0.5));
  }
  std::memcpy(out, whole.data(), sizeof whole);
  return out + sizeof whole;
}

void GltfEncoder::write_up_to(const char* end) {
  const std::string_view bytes(buffer_.data(), static_cast<std::size_t>(end - buffer_.data()));
  if (kept_) return kept_->add(bytes);
  write_body(bytes);
}

}  // namespace meshfarm
