// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The output, all of it little endian:
//   "glTF", uint32 2, uint32 length of all
//   uint32 length, "JSON", the document and blanks
//   uint32 length, "BIN\0", { stream }, zeros up to a multiple of 4, { image }
// A stream is a compressed buffer view: of positions, normals, colours, texture coordinates or
// indices. Images are stored as they are; the caller appends them. The uncompressed views lie in a
// second buffer, which is in no file.
#include "glb_compressed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t k_most_compressed_bytes = std::uint64_t{256} << 20;
constexpr unsigned k_short_bits = 16;
constexpr std::size_t k_short_uv_bytes = 2 * sizeof(std::uint16_t);
constexpr std::uint32_t k_longest_side = 16'384;  // 16 bits are exact to an eighth of a texel
constexpr int k_int8 = 5120;
constexpr int k_gl_uint16 = 5123;
constexpr const char* k_compression = "EXT_meshopt_compression";
constexpr const char* k_quantisation = "KHR_mesh_quantization";

/// The plain bytes of a mesh.
class PlainMesh {
 public:
  PlainMesh(const GltfLayout& layout, std::string bytes)
      : layout_(layout), bytes_(std::move(bytes)) {}

  std::array<float, 3> floats(std::uint64_t vertex, std::size_t offset) const {
    std::array<float, 3> made{};
    std::memcpy(made.data(), bytes_.data() + vertex * layout_.vertex_bytes + offset, sizeof made);
    return made;
  }
  Vec3 position(std::uint64_t vertex) const {
    const auto [x, y, z] = floats(vertex, 0);
    return {x, y, z};
  }
  Uv uv(std::uint64_t vertex) const {
    Uv made{};
    std::memcpy(made.data(), bytes_.data() + vertex * layout_.vertex_bytes + layout_.uv_at(),
                sizeof made);
    return made;
  }
  /// One attribute of all vertices, without gaps.
  std::string column(std::size_t offset, std::size_t bytes) const {
    std::string made(layout_.vertices * bytes, '\0');
    for (std::uint64_t v = 0; v < layout_.vertices; ++v) {
      std::memcpy(made.data() + v * bytes, bytes_.data() + v * layout_.vertex_bytes + offset,
                  bytes);
    }
    return made;
  }
  std::vector<std::uint32_t> indices() const {
    std::vector<std::uint32_t> made(3 * layout_.triangles);
    const char* from = bytes_.data() + layout_.vertices_bytes();
    for (std::uint32_t& index : made) {
      std::memcpy(&index, from, layout_.index_bytes);  // its low bytes
      from += layout_.index_bytes;
    }
    return made;
  }

 private:
  const GltfLayout& layout_;
  std::string bytes_;
};

/// Points that are a step of 2^exponent apart.
struct Lattice {
  int exponent = 0;
  std::array<double, 3> origin{};

  double step() const { return std::ldexp(1.0, exponent); }
  std::uint32_t index(double value, std::size_t axis) const {
    return static_cast<std::uint32_t>(std::lround((value - origin[axis]) / step()));
  }
  Vec3 nearest(Vec3 p) const {
    const double size = step();
    return {std::round((p.x - origin[0]) / size), std::round((p.y - origin[1]) / size),
            std::round((p.z - origin[2]) / size)};
  }
};

/// The finest lattice that spans the bounds with at most `most_steps` steps, if there is one.
std::optional<Lattice> lattice_over(const GltfBounds& bounds, std::uint32_t most_steps) {
  constexpr int k_greatest_exponent = 100;  // EXT_meshopt_compression allows no more
  std::array<double, 3> lo = bounds.lo;
  std::array<double, 3> hi = bounds.hi;
  double extent = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double shift = bounds.translation ? (*bounds.translation)[axis] : 0;
    lo[axis] += shift;
    hi[axis] += shift;
    extent = std::max(extent, hi[axis] - lo[axis]);
  }
  if (!(extent > 0)) return std::nullopt;
  Lattice made;
  std::frexp(extent / most_steps, &made.exponent);
  for (--made.exponent; std::abs(made.exponent) <= k_greatest_exponent; ++made.exponent) {
    const double step = made.step();
    bool fits = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      made.origin[axis] = std::floor(lo[axis] / step) * step;
      fits = fits && (hi[axis] - made.origin[axis]) / step <= most_steps;
    }
    if (fits) return made;
  }
  return std::nullopt;
}

/// Whether no triangle loses its area or turns over on the lattice, and at most 1 % of the
/// triangles have a least height below ten steps.
bool is_fine(const Lattice& lattice, const PlainMesh& mesh, Vec3 shift,
             std::span<const std::uint32_t> indices) {
  constexpr double k_steps = 10;
  constexpr std::uint64_t k_one_of = 100;
  const double least = k_steps * lattice.step();
  std::uint64_t low = 0;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const Vec3 a = mesh.position(indices[i]);
    const Vec3 b = mesh.position(indices[i + 1]);
    const Vec3 c = mesh.position(indices[i + 2]);
    const Vec3 normal = cross(b - a, c - a);
    const double longest =
        std::max({squared_length(b - a), squared_length(c - b), squared_length(a - c)});
    if (!(squared_length(normal) > 0)) continue;  // it has no area to lose
    if (squared_length(normal) >= least * least * longest) continue;
    const Vec3 on_a = lattice.nearest(a + shift);
    const Vec3 on_b = lattice.nearest(b + shift);
    const Vec3 on_c = lattice.nearest(c + shift);
    if (!(dot(normal, cross(on_b - on_a, on_c - on_a)) > 0)) return false;
    if (++low > indices.size() / 3 / k_one_of) return false;
  }
  return true;
}

/// Builds the bytes of a .glb and its document.
class Packer {
 public:
  Packer(const GltfLayout& layout, const GltfBounds& bounds, const GltfWords& words)
      : layout_(layout),
        bounds_(bounds),
        words_(words),
        document_(Json::parse(gltf_document(layout, bounds, words))) {
    document_["bufferViews"] = Json::array();
  }

  std::string pack(std::string binary) {
    {
      const PlainMesh mesh(layout_, std::move(binary));
      const std::vector<std::uint32_t> indices = mesh.indices();
      add_positions(mesh, indices);
      if (layout_.normals) add_normals(mesh);
      if (layout_.colours) add_colours(mesh);
      if (layout_.uvs) add_uvs(mesh);
      add_indices(indices);
    }
    describe();
    return glb();
  }

 private:
  void add_positions(const PlainMesh& mesh, std::span<const std::uint32_t> indices) {
    Vec3 shift{};
    if (bounds_.translation) {
      const auto& [x, y, z] = *bounds_.translation;
      shift = {x, y, z};
    }
    for (const unsigned bits : {k_short_bits, 18U, 20U, 22U}) {
      lattice_ = lattice_over(bounds_, (1U << bits) - 1);
      if (!lattice_ || !is_fine(*lattice_, mesh, shift, indices)) continue;
      return bits == k_short_bits ? add_places<std::uint16_t>(mesh, shift, nullptr)
                                  : add_places<std::uint32_t>(mesh, shift, "EXPONENTIAL");
    }
    lattice_.reset();
    add_vertices(mesh.column(0, 12), 12);
  }

  /// Positions on the lattice: as 16 bits, scaled by the node, or as 24 bits and an exponent, which
  /// the codec decodes to floats.
  template <class Word>
  void add_places(const PlainMesh& mesh, Vec3 shift, const char* filter) {
    is_scaled_ = sizeof(Word) == 2;
    const std::uint32_t exponent =
        is_scaled_ ? 0 : static_cast<std::uint32_t>(lattice_->exponent) << 24;
    constexpr std::size_t k_stride = sizeof(Word) == 2 ? 8 : 12;  // a multiple of four
    std::string bytes(k_stride * layout_.vertices, '\0');
    std::array<std::uint32_t, 3> lo{UINT32_MAX, UINT32_MAX, UINT32_MAX};
    std::array<std::uint32_t, 3> hi{};
    for (std::uint64_t v = 0; v < layout_.vertices; ++v) {
      const Vec3 p = mesh.position(v) + shift;
      const std::array<double, 3> position{p.x, p.y, p.z};
      std::array<Word, 3> row{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::uint32_t place = lattice_->index(position[axis], axis);
        lo[axis] = std::min(lo[axis], place);
        hi[axis] = std::max(hi[axis], place);
        row[axis] = static_cast<Word>(exponent | place);
      }
      std::memcpy(bytes.data() + k_stride * v, row.data(), sizeof row);
    }
    Json& accessor = accessor_of_next();
    if (is_scaled_) accessor["componentType"] = k_gl_uint16;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double unit = lattice_->step();
      accessor["min"][axis] = is_scaled_ ? Json(lo[axis]) : Json(unit * lo[axis]);
      accessor["max"][axis] = is_scaled_ ? Json(hi[axis]) : Json(unit * hi[axis]);
    }
    add_vertices(bytes, k_stride, filter);
  }

  void add_normals(const PlainMesh& mesh) {
    constexpr std::size_t k_stride = 4;
    constexpr std::uint64_t k_at_once = 4096;
    std::string bytes(k_stride * layout_.vertices, '\0');
    std::vector<float> rows;
    for (std::uint64_t first = 0; first < layout_.vertices; first += k_at_once) {
      const std::uint64_t end = std::min(first + k_at_once, layout_.vertices);
      rows.clear();
      for (std::uint64_t v = first; v < end; ++v) {
        const std::array<float, 3> normal = mesh.floats(v, 12);
        rows.insert(rows.end(), {normal[0], normal[1], normal[2], 0});
      }
      meshopt_encodeFilterOct(bytes.data() + k_stride * first, end - first, k_stride, 8,
                              rows.data());
    }
    Json& accessor = accessor_of_next();
    accessor["componentType"] = k_int8;
    accessor["normalized"] = true;
    add_vertices(bytes, k_stride, "OCTAHEDRAL");
  }

  void add_colours(const PlainMesh& mesh) {
    add_vertices(mesh.column(layout_.colour_at(), layout_.colour_bytes), layout_.colour_bytes);
  }

  /// With 16 bits where that is fine enough.
  void add_uvs(const PlainMesh& mesh) {
    bool is_fine = std::all_of(words_.images.begin(), words_.images.end(),
                               [](const auto& image) { return image.side <= k_longest_side; });
    for (std::uint64_t v = 0; v < layout_.vertices && is_fine; ++v) {
      const Uv uv = mesh.uv(v);
      is_fine = uv[0] >= 0 && uv[0] <= 1 && uv[1] >= 0 && uv[1] <= 1;
    }
    if (!is_fine) return add_vertices(mesh.column(layout_.uv_at(), sizeof(Uv)), sizeof(Uv));
    std::string bytes(k_short_uv_bytes * layout_.vertices, '\0');
    for (std::uint64_t v = 0; v < layout_.vertices; ++v) {
      std::array<std::uint16_t, 2> row{};
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double whole = static_cast<double>(mesh.uv(v)[axis]) * UINT16_MAX;
        row[axis] = static_cast<std::uint16_t>(std::floor(whole + 0.5));
      }
      std::memcpy(bytes.data() + k_short_uv_bytes * v, row.data(), sizeof row);
    }
    Json& accessor = accessor_of_next();
    accessor["componentType"] = k_gl_uint16;
    accessor["normalized"] = true;
    add_vertices(bytes, k_short_uv_bytes);
  }

  void add_vertices(const std::string& bytes, std::size_t stride, const char* filter = nullptr) {
    meshopt_encodeVertexVersion(0);
    std::vector<unsigned char> made(meshopt_encodeVertexBufferBound(layout_.vertices, stride));
    made.resize(meshopt_encodeVertexBuffer(made.data(), made.size(), bytes.data(), layout_.vertices,
                                           stride));
    accessor_of_next()["bufferView"] = document_["bufferViews"].size();
    accessor_of_next()["byteOffset"] = 0;
    Json& view = add_view(made, layout_.vertices, stride, "ATTRIBUTES", filter);
    view["byteStride"] = stride;
    view["target"] = 34962;
  }

  /// The single view for all accessors of indices.
  void add_indices(std::span<const std::uint32_t> indices) {
    meshopt_encodeIndexVersion(1);
    std::vector<unsigned char> made(
        meshopt_encodeIndexBufferBound(indices.size(), layout_.vertices));
    made.resize(
        meshopt_encodeIndexBuffer(made.data(), made.size(), indices.data(), indices.size()));
    const std::size_t number = document_["bufferViews"].size();
    for (std::size_t i = number; i < document_["accessors"].size(); ++i) {
      document_["accessors"][i]["bufferView"] = number;
    }
    add_view(made, indices.size(), layout_.index_bytes, "TRIANGLES", nullptr)["target"] = 34963;
  }

  /// Each attribute has one view, in the order of the accessors.
  Json& accessor_of_next() { return document_["accessors"][document_["bufferViews"].size()]; }

  Json& add_view(std::span<const unsigned char> stream, std::uint64_t rows, std::size_t stride,
                 const char* mode, const char* filter) {
    Json compression = {{"buffer", 0},
                        {"byteOffset", binary_.size()},
                        {"byteLength", stream.size()},
                        {"byteStride", stride},
                        {"mode", mode},
                        {"count", rows}};
    if (filter != nullptr) compression["filter"] = filter;
    document_["bufferViews"].push_back({{"buffer", 1},
                                        {"byteOffset", unpacked_},
                                        {"byteLength", rows * stride},
                                        {"extensions", {{k_compression, compression}}}});
    unpacked_ += (rows * stride + 3) / 4 * 4;
    binary_.append(reinterpret_cast<const char*>(stream.data()), stream.size());
    binary_.resize((binary_.size() + 3) / 4 * 4);
    return document_["bufferViews"].back();
  }

  /// Places the images after all streams. Returns the end of the last.
  std::uint64_t add_images() {
    std::uint64_t end = binary_.size();
    std::uint64_t next = end;
    for (std::size_t i = 0; i < words_.images.size(); ++i) {
      const std::uint64_t bytes = words_.images[i].bytes;
      Json& views = document_["bufferViews"];
      document_["images"][i]["bufferView"] = views.size();
      views.push_back({{"buffer", 0}, {"byteOffset", next}, {"byteLength", bytes}});
      end = next + bytes;
      next = padded_to_4(end);
    }
    return end;
  }

  void describe() {
    const std::uint64_t end = add_images();
    document_["buffers"] = {
        {{"byteLength", end}},
        {{"byteLength", unpacked_}, {"extensions", {{k_compression, {{"fallback", true}}}}}}};
    Json extensions = {k_compression};
    if (is_scaled_ || layout_.normals) extensions.push_back(k_quantisation);
    document_["extensionsUsed"] = extensions;
    document_["extensionsRequired"] = extensions;
    if (!lattice_) return;
    Json& node = document_["nodes"][0];
    node["translation"] = lattice_->origin;
    const double step = lattice_->step();
    if (is_scaled_) node["scale"] = {step, step, step};
  }

  std::string glb() const {
    std::string json = document_.dump(-1, ' ', false, Json::error_handler_t::replace);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string made;
    made.reserve(28 + json.size() + binary_.size());
    const std::size_t length = binary_.size() + words_.image_bytes();
    const auto put = [&](std::size_t word) {
      const auto bytes = static_cast<std::uint32_t>(word);
      made.append(reinterpret_cast<const char*>(&bytes), sizeof bytes);
    };
    for (const std::size_t word : {std::size_t{0x46546c67}, std::size_t{2},
                                   28 + json.size() + length, json.size(), std::size_t{0x4e4f534a}})
      put(word);
    made += json;
    put(length);
    put(0x004e4942);
    made += binary_;
    return made;
  }

  const GltfLayout& layout_;
  const GltfBounds& bounds_;
  const GltfWords& words_;
  Json document_;
  std::optional<Lattice> lattice_;
  bool is_scaled_ = false;  // the node scales the lattice's positions; else they are floats
  std::string binary_;
  std::uint64_t unpacked_ = 0;  // bytes of all views
};

}  // namespace

bool can_compress_glb(const GltfLayout& layout) {
  return layout.vertices > 0 && layout.triangles > 0 &&
         layout.binary_bytes() <= k_most_compressed_bytes;
}

std::string compressed_glb(const GltfLayout& layout, const GltfBounds& bounds,
                           const GltfWords& words, std::string binary) {
  return Packer(layout, bounds, words).pack(std::move(binary));
}

}  // namespace meshfarm
