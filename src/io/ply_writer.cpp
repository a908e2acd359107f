// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// What is written:
//   header  = "ply" "format binary_little_endian 1.0" ["comment" text]
//             "element vertex" N, property (float | double) x, y, z
//             "element face" M, property list uchar (int | uint) vertex_indices "end_header"
//   vertex  = x y z;  face = 3 a b c
#include <cerrno>
#include <cstring>

#include <meshfarm/io/ply_writer.hpp>
#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::size_t k_triangle_bytes = 1 + 3 * sizeof(std::uint32_t);
constexpr std::size_t k_records_at_once = 8192;

/// Fails before the work, not after it, if the file cannot be made.
const std::filesystem::path& checked_path(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (path.empty()) throw IoError("cannot write", path, ENOENT);
  if (std::filesystem::is_directory(status)) throw IoError("cannot write", path, EISDIR);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw IoError("cannot replace what is not a regular file:", path, EINVAL);
  }
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, error)) {
    const bool exists = std::filesystem::exists(folder, error);
    throw IoError("cannot write", path, exists ? ENOTDIR : ENOENT);
  }
  if (!path.has_filename()) throw IoError("cannot write", path, EISDIR);
  return path;
}

const PlyWriterOptions& checked_options(const PlyWriterOptions& options) {
  if (options.vertices > std::uint64_t{1} << 32) {
    throw UsageError("a PLY file with " + std::to_string(options.vertices) +
                     " vertices cannot be written: its indices have 32 bits");
  }
  if (options.comment.find_first_of("\r\n") != std::string::npos) {
    throw UsageError("the comment of a PLY file is one line");
  }
  return options;
}

std::string header_text(const PlyWriterOptions& options) {
  const std::string type = options.positions == PositionType::float32 ? "float" : "double";
  const std::string index = options.vertices <= std::uint64_t{1} << 31 ? "int" : "uint";
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  if (!options.comment.empty()) text += "comment " + options.comment + "\n";
  text += "element vertex " + std::to_string(options.vertices) + "\n";
  for (const char* axis : {"x", "y", "z"}) text += "property " + type + " " + axis + "\n";
  text += "element face " + std::to_string(options.triangles) + "\n";
  return text + "property list uchar " + index + " vertex_indices\nend_header\n";
}

template <class Real>
char* encode(const Vec3& vertex, char* out) {
  const Real xyz[] = {static_cast<Real>(vertex.x), static_cast<Real>(vertex.y),
                      static_cast<Real>(vertex.z)};
  std::memcpy(out, xyz, sizeof xyz);
  return out + sizeof xyz;
}

}  // namespace

class PlyWriter::Impl {
 public:
  Impl(const std::filesystem::path& path, const PlyWriterOptions& options)
      : path_(path), options_(checked_options(options)), file_(checked_path(path)) {
    file_.write(header_text(options_));
  }

  void vertices(std::span<const Vec3> batch) {
    vertices_ = counted(vertices_, batch.size(), options_.vertices, "vertices");
    for (; !batch.empty(); batch = batch.subspan(std::min(batch.size(), k_records_at_once))) {
      char* out = buffer_.data();
      for (const Vec3& vertex : batch.first(std::min(batch.size(), k_records_at_once))) {
        out = options_.positions == PositionType::float32 ? encode<float>(vertex, out)
                                                          : encode<double>(vertex, out);
      }
      write_up_to(out);
    }
  }

  template <class AnyTriangle>
  void triangles(std::span<const AnyTriangle> batch) {
    if (vertices_ != options_.vertices) wrong_count(vertices_, options_.vertices, "vertices");
    triangles_ = counted(triangles_, batch.size(), options_.triangles, "triangles");
    for (; !batch.empty(); batch = batch.subspan(std::min(batch.size(), k_records_at_once))) {
      char* out = buffer_.data();
      for (const AnyTriangle& triangle : batch.first(std::min(batch.size(), k_records_at_once))) {
        *out++ = 3;
        for (const auto index : triangle) {
          if (index >= options_.vertices) wrong_index(index);
          const auto narrow = static_cast<std::uint32_t>(index);
          std::memcpy(out, &narrow, sizeof narrow);
          out += sizeof narrow;
        }
      }
      write_up_to(out);
    }
  }

  void commit() {
    if (vertices_ != options_.vertices) wrong_count(vertices_, options_.vertices, "vertices");
    if (triangles_ != options_.triangles) wrong_count(triangles_, options_.triangles, "triangles");
    file_.commit();
  }

 private:
  std::uint64_t counted(std::uint64_t before, std::uint64_t more, std::uint64_t promised,
                        const char* what) const {
    if (more > promised - before) wrong_count(before + more, promised, what);
    return before + more;
  }
  [[noreturn]] void wrong_count(std::uint64_t written, std::uint64_t promised,
                                const char* what) const {
    throw DataError(path_.string() + ": " + std::to_string(written) + " " + what +
                    " were given to be written, but " + std::to_string(promised) +
                    " were promised");
  }
  [[noreturn]] void wrong_index(std::uint64_t index) const {
    throw DataError(path_.string() + ": a triangle to be written has vertex " +
                    std::to_string(index) + " of " + std::to_string(options_.vertices));
  }
  void write_up_to(const char* end) {
    file_.write({buffer_.data(), static_cast<std::size_t>(end - buffer_.data())});
  }

  std::filesystem::path path_;
  PlyWriterOptions options_;
  AtomicFile file_;
  std::vector<char> buffer_ =
      std::vector<char>(k_records_at_once * std::max(k_triangle_bytes, sizeof(Vec3)));
  std::uint64_t vertices_ = 0;
  std::uint64_t triangles_ = 0;
};

PlyWriter::PlyWriter(const std::filesystem::path& path, const PlyWriterOptions& options)
    : impl_(std::make_unique<Impl>(path, options)) {}

PlyWriter::~PlyWriter() = default;

void PlyWriter::vertices(std::span<const Vec3> batch) {
  impl_->vertices(batch);
}

void PlyWriter::triangles(std::span<const WideTriangle> batch) {
  impl_->triangles(batch);
}

void PlyWriter::triangles(std::span<const Triangle> batch) {
  impl_->triangles(batch);
}

void PlyWriter::commit() {
  impl_->commit();
}

void write_ply(const std::filesystem::path& path, const Mesh& mesh, PositionType positions) {
  PlyWriterOptions options;
  options.vertices = mesh.positions.size();
  options.triangles = mesh.triangles.size();
  options.positions = positions;
  PlyWriter writer(path, options);
  writer.vertices(mesh.positions);
  writer.triangles(mesh.triangles);
  writer.commit();
}

}  // namespace meshfarm
