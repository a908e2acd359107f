// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The output:
//   header  = "ply" "format binary_little_endian 1.0" ["comment" text]
//             { "comment TextureFile" name }
//             "element vertex" N, property (float | double) x, y, z,
//             property (uchar | ushort | float) of each channel
//             "element face" M, property list uchar (int | uint) vertex_indices,
//             [property list uchar float texcoord, [property int texnumber]]
//             property (uchar | ushort | uint) of the labels "end_header"
//   vertex  = x y z values;  face = 3 a b c [6 u v u v u v [texnumber]] [label]
// A texnumber is an index of the TextureFiles, or -1. It is written only if triangles differ in it.
#include <algorithm>
#include <bit>
#include <cstring>

#include <meshfarm/io/ply_writer.hpp>
#include <meshfarm/util/errors.hpp>

#include "corner_wedges.hpp"
#include "file_sink.hpp"
#include "pictures_beside.hpp"

namespace meshfarm {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::size_t k_triangle_bytes = 1 + 3 * sizeof(std::uint32_t);
constexpr std::size_t k_uv_bytes = 1 + sizeof(CornerUvs);

const MeshSinkOptions& checked_vertices(const MeshSinkOptions& options) {
  if (options.vertices > std::uint64_t{1} << 32) {
    throw UsageError("a PLY file with " + std::to_string(options.vertices) +
                     " vertices cannot be written: its indices have 32 bits");
  }
  return options;
}

std::string_view name_of(ChannelType type) {
  if (type == ChannelType::float32) return "float";
  return type == ChannelType::uint8 ? "uchar" : "ushort";
}

std::size_t vertex_bytes(const MeshSinkOptions& options) {
  std::size_t bytes = 3 * static_cast<std::size_t>(options.positions);
  for (const Channel& channel : options.channels) bytes += static_cast<std::size_t>(channel.type);
  return bytes;
}

/// As few as the materials need; 4 if their number is not known.
std::size_t label_bytes(const MeshSinkOptions& options) {
  if (!options.labels) return 0;
  const std::size_t count = options.labels->materials.size();
  if (count == 0 || count > std::size_t{UINT16_MAX} + 1) return 4;
  return count > std::size_t{UINT8_MAX} + 1 ? 2 : 1;
}

/// One word. Materials have the name that other programs use.
std::string label_line(const MeshSinkOptions& options) {
  std::string name = options.labels->name;
  for (char& c : name) {
    if (static_cast<unsigned char>(c) <= ' ') c = '_';
  }
  const bool is_taken = options.uvs && (name == "texnumber" || name == "texcoord");
  if (name == "material" || is_taken) name = "material_index";
  if (name.empty() || name == "vertex_indices") name = "label";
  const std::size_t bytes = label_bytes(options);
  const std::string type = bytes == 4 ? "uint" : bytes == 2 ? "ushort" : "uchar";
  return "property " + type + " " + name + "\n";
}

/// The pictures that a mesh with texture coordinates has as colours, and the one of each material.
struct ColourPictures {
  std::vector<std::size_t> pictures;   // each once, in the order of the materials
  std::vector<std::int32_t> of_label;  // index among these, or -1

  explicit ColourPictures(const MeshSinkOptions& options) {
    if (!options.uvs || !options.labels) return;
    for (const Material& material : options.labels->materials) {
      of_label.push_back(number_of(material));
    }
  }
  /// Whether they are not all the same.
  bool differ() const {
    return std::any_of(of_label.begin(), of_label.end(),
                       [this](std::int32_t number) { return number != of_label.front(); });
  }

 private:
  std::int32_t number_of(const Material& material) {
    const auto map =
        std::find_if(material.maps.begin(), material.maps.end(),
                     [](const MaterialMap& each) { return each.use == MapUse::colour; });
    if (map == material.maps.end()) return -1;
    const auto found = std::find(pictures.begin(), pictures.end(), map->picture);
    const auto number = static_cast<std::int32_t>(found - pictures.begin());
    if (found == pictures.end()) pictures.push_back(map->picture);
    return number;
  }
};

std::string header_text(const MeshSinkOptions& options, const ColourPictures& colours,
                        PicturesBeside& beside) {
  const std::string type = options.positions == PositionType::float32 ? "float" : "double";
  const std::string index = options.vertices <= std::uint64_t{1} << 31 ? "int" : "uint";
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  if (!options.comment.empty()) text += "comment " + options.comment + "\n";
  for (const std::size_t picture : colours.pictures) {
    text += "comment TextureFile " + beside.name_of(picture) + "\n";
  }
  text += "element vertex " + std::to_string(options.vertices) + "\n";
  for (const char* axis : {"x", "y", "z"}) text += "property " + type + " " + axis + "\n";
  for (const Channel& channel : options.channels) {
    text += "property " + std::string(name_of(channel.type)) + " " + channel.name + "\n";
  }
  text += "element face " + std::to_string(options.triangles) + "\n";
  text += "property list uchar " + index + " vertex_indices\n";
  if (options.uvs) text += "property list uchar float texcoord\n";
  if (colours.differ()) text += "property int texnumber\n";
  if (options.labels) text += label_line(options);
  return text + "end_header\n";
}

template <class Real>
char* encode(const Vec3& vertex, char* out) {
  const Real xyz[] = {static_cast<Real>(vertex.x), static_cast<Real>(vertex.y),
                      static_cast<Real>(vertex.z)};
  std::memcpy(out, xyz, sizeof xyz);
  return out + sizeof xyz;
}

template <class T>
char* encode(float value, char* out) {
  const T narrow = static_cast<T>(value);
  std::memcpy(out, &narrow, sizeof narrow);
  return out + sizeof narrow;
}

char* encode(ChannelType type, float value, char* out) {
  const float whole = rounded_to(type, value);
  if (type == ChannelType::float32) return encode<float>(whole, out);
  return type == ChannelType::uint8 ? encode<std::uint8_t>(whole, out)
                                    : encode<std::uint16_t>(whole, out);
}

char* encode(const CornerUvs& uvs, char* out) {
  *out++ = 6;
  for (const Uv& each : uvs) {
    const Uv uv = finite_uv(each);
    std::memcpy(out, uv.data(), sizeof uv);
    out += sizeof uv;
  }
  return out;
}

class PlySink final : public FileSink {
 public:
  PlySink(const std::filesystem::path& path, const MeshSinkOptions& options)
      : FileSink(path, checked_vertices(options)),
        colours_(options),
        beside_(path, options.pictures) {
    write(header_text(options, colours_, beside_));
  }

 private:
  void put(std::span<const Vec3> batch, std::span<const float> values) override {
    char* out = buffer_.data();
    const float* value = values.data();
    for (const Vec3& vertex : batch) {
      out = options().positions == PositionType::float32 ? encode<float>(vertex, out)
                                                         : encode<double>(vertex, out);
      for (const Channel& channel : options().channels) out = encode(channel.type, *value++, out);
    }
    write_up_to(out);
  }

  void put(const TriangleView& batch) override {
    char* out = buffer_.data();
    for (std::size_t i = 0; i < batch.size(); ++i) {
      *out++ = 3;
      for (const std::uint64_t index : batch.corners[i]) {
        const auto narrow = static_cast<std::uint32_t>(index);
        std::memcpy(out, &narrow, sizeof narrow);
        out += sizeof narrow;
      }
      if (options().uvs) out = encode(batch.columns.uvs[i], out);
      if (has_texture_numbers_) {
        const std::int32_t number = colours_.of_label[batch.columns.labels[i]];
        std::memcpy(out, &number, sizeof number);
        out += sizeof number;
      }
      if (label_bytes_ == 0) continue;
      std::memcpy(out, &batch.columns.labels[i], label_bytes_);  // its low bytes
      out += label_bytes_;
    }
    write_up_to(out);
  }

  void finish() override {
    if (colours_.pictures.empty()) return;
    beside_.finish();
    make_way();
    beside_.commit();
  }

  void write_up_to(const char* end) {
    write({buffer_.data(), static_cast<std::size_t>(end - buffer_.data())});
  }

  ColourPictures colours_;
  PicturesBeside beside_;
  bool has_texture_numbers_ = colours_.differ();
  std::size_t label_bytes_ = label_bytes(options());
  std::size_t face_bytes_ = k_triangle_bytes + (options().uvs ? k_uv_bytes : 0) +
                            (has_texture_numbers_ ? sizeof(std::int32_t) : 0) + label_bytes_;
  std::vector<char> buffer_ =
      std::vector<char>(k_most_at_once * std::max(face_bytes_, vertex_bytes(options())));
};

}  // namespace

std::unique_ptr<MeshSink> create_ply(const std::filesystem::path& path,
                                     const MeshSinkOptions& options) {
  return std::make_unique<PlySink>(path, options);
}

void write_ply(const std::filesystem::path& path, const Mesh& mesh, PositionType positions) {
  const auto sink = create_ply(path, {.vertices = mesh.positions.size(),
                                      .triangles = mesh.triangles.size(),
                                      .positions = positions,
                                      .comment = {}});
  sink->vertices(mesh.positions);
  sink->triangles(mesh.triangles);
  sink->commit();
}

}  // namespace meshfarm
