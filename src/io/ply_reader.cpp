// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "ply_reader.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "coloured_points.hpp"
#include "off_header.hpp"
#include "ply_body.hpp"
#include "ply_header.hpp"
#include "ply_positions.hpp"
#include "ply_textures.hpp"
#include "vertex_store.hpp"

namespace meshfarm {
namespace {

std::string_view name_of(PlyFormat format) {
  switch (format) {
    case PlyFormat::ascii:
      return "PLY ascii";
    case PlyFormat::binary_little:
      return "PLY binary little endian";
    case PlyFormat::binary_big:
      return "PLY binary big endian";
  }
  return "";
}

bool is_used(const PlyElement& element, std::size_t property,
             std::span<const PlyChannel> channels) {
  if (element.role != PlyRole::vertices) {
    return property == element.index_list || property == element.label || property == element.uvs;
  }
  return std::find(element.axes.begin(), element.axes.end(), property) != element.axes.end() ||
         std::any_of(channels.begin(), channels.end(),
                     [&](const PlyChannel& channel) { return channel.property == property; });
}

std::vector<std::string> skipped_names(const PlyHeader& header,
                                       std::span<const PlyChannel> channels) {
  std::vector<std::string> names;
  for (const PlyElement& element : header.elements) {
    if (element.role == PlyRole::other) {
      names.push_back(element.name + " (" + std::to_string(element.count) + " elements)");
      continue;
    }
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      if (!is_used(element, i, channels))
        names.push_back(element.name + "." + element.properties[i].name);
    }
  }
  return names;
}

/// Refuses counts that the file is too short for. `at`: where the body begins.
void check_counts(const PlyHeader& header, std::uint64_t at, std::uint64_t body_bytes,
                  const std::filesystem::path& path) {
  std::uint64_t left = body_bytes;
  if (header.format == PlyFormat::ascii) ++left;  // the last line may lack its end
  for (const PlyElement& element : header.elements) {
    const std::uint64_t record = element.record_bytes(header.format);
    if (record == 0) continue;
    if (element.count > left / record) {
      const bool varies = header.format == PlyFormat::ascii || element.has_lists();
      throw DataError(path.string() + ": truncated, or the header is wrong: it claims " +
                      std::to_string(element.count) + " records of element " + element.name +
                      " of " + std::to_string(record) + (varies ? " bytes or more" : " bytes") +
                      ", but the file ends at byte " + std::to_string(at + body_bytes) + ", in " +
                      element.name + " " + std::to_string(left / record) + " at the latest");
    }
    left -= element.count * record;
  }
}

/// PLY files, and those with an equivalent header: OFF.
class PlySource final : public MeshSource {
 public:
  using ParseHeader = PlyHeader (*)(std::string_view start, const std::filesystem::path& path);

  PlySource(InputFile file, const OpenOptions& options, ParseHeader parse_header)
      : file_(std::move(file)), options_(options) {
    const std::unique_ptr<ByteStream> stream = file_.open();
    const std::string_view start = stream->window(ByteStream::k_max_window_bytes);
    header_ = parse_header(start.substr(0, ByteStream::k_max_window_bytes), file_.path());
    for (const std::string& oddity : header_.oddities) warn(oddity);
    stream->consume(header_.size_bytes);
    if (const std::optional<std::uint64_t> body_bytes = stream->remaining()) {
      check_counts(header_, header_.size_bytes, *body_bytes, file_.path());
    }
    fill_info();
    if (has_more_digits_than_floats()) read_as_doubles();
    if (options.channels) read_textures();
  }

  const MeshFileInfo& info() const override { return info_; }
  std::uint64_t small_faces() const override { return small_faces_; }

  void scan_vertices(const std::function<void(std::span<const Vec3>)>& take) override {
    if (store_.is_filled()) return store_.scan(take);
    parked_ = read_vertices(take, is_worth_keeping() ? Keep::where_possible : Keep::no);
  }

  void scan_channels(const std::function<void(const ChannelPoints&)>& take) override {
    if (!texture_colours_) return scan_properties(channels_, take);
    std::uint64_t first = 0;
    scan_properties(channels_, [&](const ChannelPoints& batch) {
      take(colours_->of(batch, first));
      first += batch.points.size();
    });
  }

  void scan_triangles(const std::function<void(const TriangleView&)>& take) override {
    info_.uvs ? scan_textured(take) : scan_plain(take);
  }

 private:
  using Keep = VertexStore::Keep;

  void scan_properties(std::span<const PlyChannel> properties,
                       const std::function<void(const ChannelPoints&)>& take) {
    const std::unique_ptr<PlyBody> body = open_body();
    std::size_t next = 0;
    while (header_.elements[next].role != PlyRole::vertices) body->skip(header_.elements[next++]);
    ChannelBatch batch(take);
    body->read_channels(header_.elements[next], properties, batch);
  }

  void scan_textured(const std::function<void(const TriangleView&)>& take) {
    if (!textured_) {
      textured_.emplace(textures_);
      if (!textures_.of_vertices.empty()) {
        textured_->begin_vertices(info_.vertices);
        scan_properties(textures_.of_vertices,
                        [this](const ChannelPoints& batch) { textured_->add_vertices(batch); });
      }
    }
    scan_plain([&](const TriangleView& batch) {
      TriangleView made = textured_->of(batch);
      if (!info_.labels && !is_sampling_) made.columns.labels = {};
      take(made);
    });
  }

  void scan_plain(const std::function<void(const TriangleView&)>& take) {
    // Continues where the last scan of the vertices stopped, if that is before all triangles.
    auto [body, next] = std::exchange(parked_, {});
    const auto first = std::find_if(header_.elements.begin(), header_.elements.end(), has_corners);
    if (!body || first - header_.elements.begin() < static_cast<std::ptrdiff_t>(next)) {
      body = open_body();
      next = 0;
    }
    TriangleMaker maker(info_.vertices, take, [this](std::uint64_t v) { return position_of(v); });
    if (std::any_of(header_.elements.begin(), header_.elements.end(),
                    [](const PlyElement& element) { return element.has_late_label(); })) {
      maker.hold_long_faces();
    }
    if (std::any_of(header_.elements.begin(), header_.elements.end(),
                    [](const PlyElement& element) { return element.uvs.has_value(); })) {
      maker.keep_uvs();
    }
    for (; next < header_.elements.size(); ++next) {
      const PlyElement& element = header_.elements[next];
      has_corners(element) ? body->read_corners(element, maker) : body->skip(element);
    }
    small_faces_ = maker.small_faces();
    if (maker.guessed_faces() > 0) warn(maker.guess_warning(file_.path()));
    warn(body->take_oddity());
    if (!body->at_end()) {
      warn(file_.path().string() + ": there is more in the file than its header says");
    }
  }

  /// A body whose next element is `next`.
  struct Parked {
    std::unique_ptr<PlyBody> body;
    std::size_t next = 0;
  };

  /// Reads all vertices. Returns the body and the next element.
  Parked read_vertices(const std::function<void(std::span<const Vec3>)>& take, Keep keep) {
    std::unique_ptr<PlyBody> body = open_body();
    std::size_t next = 0;
    while (header_.elements[next].role != PlyRole::vertices) body->skip(header_.elements[next++]);
    const PlyElement& vertices = header_.elements[next++];
    store_.fill({info_.positions, vertices.count, keep}, take, [&](const VertexStore::Take& pass) {
      Batch<Vec3> batch(pass);
      body->read_vertices(vertices, batch);
      return !body->has_lost_digits();
    });
    warn(body->take_oddity());
    if (body->has_lost_digits()) read_as_doubles();  // from the next scan on
    return {std::move(body), next};
  }

  void read_as_doubles() {
    floats_ = AsciiFloats::as_doubles;
    info_.positions = PositionType::float64;
  }

  /// Whether the first vertices already show it: this saves reading all of them twice.
  bool has_more_digits_than_floats() const {
    constexpr std::uint64_t k_few = 1024;
    if (header_.format != PlyFormat::ascii || info_.positions != PositionType::float32)
      return false;
    const PlyElement& first = header_.elements.front();
    if (first.role != PlyRole::vertices) return false;
    PlyElement few = first;
    few.count = std::min(few.count, k_few);
    const std::unique_ptr<PlyBody> body = open_body(1);
    const Batch<Vec3>::Take nothing = [](std::span<const Vec3>) {};
    Batch<Vec3> batch(nothing);
    try {
      body->read_vertices(few, batch);
    } catch (const DataError&) {
      return false;  // the scan that follows reports the error
    }
    return body->has_lost_digits();
  }

  /// Called for polygons only. Uses what there is, or else another scan.
  Vec3 position_of(std::uint64_t vertex) {
    if (store_.is_filled()) return store_.at(vertex);
    if (!positions_) positions_ = PlyPositions::in_file(file_, header_);
    if (positions_) return positions_->at(vertex);
    read_vertices([](std::span<const Vec3>) {}, Keep::always);
    return position_of(vertex);  // a second scan, if digits were lost
  }

  static bool has_corners(const PlyElement& element) {
    return element.role == PlyRole::faces || element.role == PlyRole::strips;
  }

  /// Parsing or decompressing again takes longer than all else that a scan does.
  bool is_worth_keeping() const {
    const bool is_slow =
        header_.format == PlyFormat::ascii || file_.compression() != Compression::none;
    return is_slow && options_.scans == Scans::many;
  }

  void fill_info() {
    info_.format = header_.title.empty() ? name_of(header_.format) : header_.title;
    info_.compression = name_of(file_.compression());
    info_.vertices = header_.vertices().count;
    info_.positions = position_type_of(header_.vertices());
    if (options_.channels) channels_ = channels_of(header_.vertices());
    for (const PlyChannel& each : channels_) info_.channels.push_back(each.channel);
    if (options_.labels) find_labels();
    textures_ = find_ply_textures(header_);
    if (options_.textures == Textures::keep && textures_.has_uvs()) keep_textures();
    info_.skipped = skipped_names(header_, used_properties());
    for (const PlyElement& element : header_.elements) {
      if (has_corners(element)) info_.faces += element.count;
    }
  }

  /// Strips have none, and either all triangles have labels or none.
  void find_labels() {
    PlyElement* faces = nullptr;
    for (PlyElement& element : header_.elements) {
      if (!has_corners(element) || element.count == 0) continue;
      if (element.role == PlyRole::strips) return;
      faces = &element;
    }
    if (faces == nullptr || !(faces->label = label_of(*faces))) return;
    info_.labels = LabelMeaning{faces->properties[*faces->label].name, {}};
  }

  /// The faces that have texture coordinates, or indices of pictures.
  PlyElement& textured_faces() {
    return *std::find_if(header_.elements.begin(), header_.elements.end(), [](const auto& element) {
      return element.role == PlyRole::faces && element.count > 0;
    });
  }

  std::vector<PlyChannel> used_properties() const {
    std::vector<PlyChannel> made = channels_;
    if (info_.uvs) {
      made.insert(made.end(), textures_.of_vertices.begin(), textures_.of_vertices.end());
    }
    return made;
  }

  /// Pictures belong to materials; these take precedence over all else that labels may mean.
  void read_uvs() {
    textured_faces().uvs = textures_.face_list;
    if (!textures_.files.empty()) textured_faces().label = textures_.numbers;
    info_.uvs = true;
  }

  void keep_textures() {
    const bool has_pictures = !textures_.files.empty();
    if (has_pictures && !options_.labels) textures_.numbers.reset();
    read_uvs();
    if (!has_pictures || !options_.labels) return;
    info_.labels = keep_ply_pictures(
        textures_, file_.path(), [this](const std::string& line) { warn(line); }, info_.pictures);
  }

  void read_textures() {
    if (textures_.files.empty() || !textures_.has_uvs()) return;
    if (options_.textures == Textures::name) {
      info_.textures = describe(ply_images(textures_, file_.path()), LostPictures::told);
    } else if (options_.textures == Textures::bake) {
      bake_textures();
    }
  }

  void bake_textures() {
    PlyElement& faces = textured_faces();
    const std::optional<std::size_t> label = faces.label;
    read_uvs();
    is_sampling_ = true;
    const bool has_colours = colour_columns(info_.channels).has_value();
    texture_colours_ = sample_ply_textures(
        {.textures = textures_,
         .path = file_.path(),
         .vertices = info_.vertices,
         .plain = has_colours ? TextureColours::Plain::left : TextureColours::Plain::coloured,
         .picture_bytes = options_.picture_bytes},
        [this](const auto& take) { scan_textured(take); });
    is_sampling_ = false;
    textured_.reset();
    info_.uvs = false;
    faces.uvs.reset();
    const bool is_number = label && label == textures_.numbers;
    faces.label = texture_colours_ && is_number ? std::nullopt : label;
    if (!texture_colours_) return;
    if (is_number) info_.labels.reset();
    info_.textures = describe(ply_images(textures_, file_.path()), LostPictures::left);
    colours_.emplace(info_.channels, *texture_colours_);
    info_.channels = colours_->channels();
  }

  /// A file is scanned more than once, but each warning about it is given only once.
  void warn(const std::string& line) {
    if (!line.empty() && warnings_.insert(line).second) log_warning(line);
  }

  std::unique_ptr<PlyBody> open_body() const { return open_body(options_.threads); }
  std::unique_ptr<PlyBody> open_body(unsigned threads) const {
    std::unique_ptr<ByteStream> stream = file_.open();
    stream->skip(header_.size_bytes);
    return header_.format == PlyFormat::ascii
               ? make_ascii_body(std::move(stream), file_.path(), header_,
                                 {floats_, threads, header_.has_comments})
               : make_binary_body(std::move(stream), file_.path(), header_);
  }

  InputFile file_;
  OpenOptions options_;
  PlyHeader header_;
  std::vector<PlyChannel> channels_;
  VertexStore store_;
  AsciiFloats floats_ = AsciiFloats::as_floats;
  std::unique_ptr<PlyPositions> positions_;
  Parked parked_;
  MeshFileInfo info_;
  std::uint64_t small_faces_ = 0;
  std::set<std::string> warnings_;
  PlyTextures textures_;
  std::optional<PlyTexturedBatch> textured_;
  std::unique_ptr<TextureColours> texture_colours_;
  std::optional<ColouredPoints> colours_;
  bool is_sampling_ = false;
};

}  // namespace

bool is_ply_file(const InputFile& file) {
  return is_ply(file.open()->window(ByteStream::k_max_window_bytes));
}

std::unique_ptr<MeshSource> open_ply(InputFile file, const OpenOptions& options) {
  return std::make_unique<PlySource>(std::move(file), options, parse_ply_header);
}

bool is_off_file(const InputFile& file) {
  return is_off(file.open()->window(ByteStream::k_max_window_bytes));
}

std::unique_ptr<MeshSource> open_off(InputFile file, const OpenOptions& options) {
  return std::make_unique<PlySource>(std::move(file), options, parse_off_header);
}

}  // namespace meshfarm
