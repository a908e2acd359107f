// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The output, all of it little endian:
//   file  = 80 bytes: the comment, or "meshfarm", and zeros; uint32 count; { facet }
//   facet = float normal[3], float vertex[3][3], uint16 0
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include <meshfarm/util/errors.hpp>

#include "file_sink.hpp"
#include "mesh_writers.hpp"
#include "vertex_store.hpp"

namespace meshfarm {
namespace {

constexpr std::size_t k_comment_bytes = 80;
constexpr std::size_t k_written_facet_bytes = 50;

const MeshSinkOptions& checked_triangles(const MeshSinkOptions& options) {
  if (options.triangles > UINT32_MAX) {
    throw UsageError("an STL file with " + std::to_string(options.triangles) +
                     " triangles cannot be written: it counts them with 32 bits");
  }
  return options;
}

char* encode(Vec3 p, char* out) {
  static_assert(std::endian::native == std::endian::little);
  const std::array<float, 3> xyz{static_cast<float>(p.x), static_cast<float>(p.y),
                                 static_cast<float>(p.z)};
  std::memcpy(out, xyz.data(), sizeof xyz);
  return out + sizeof xyz;
}

Vec3 normal_of(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 area = cross(b - a, c - a);
  const double size = length(area);
  return size > 0 && std::isfinite(size) ? area * (1 / size) : Vec3{};
}

class StlSink final : public FileSink {
 public:
  StlSink(const std::filesystem::path& path, const MeshSinkOptions& options)
      : FileSink(path, checked_triangles(options)), kept_(PositionType::float32, options.vertices) {
    // Some readers take a file that begins with "solid" for text.
    std::string comment = options.comment.empty() ? "meshfarm" : "meshfarm: " + options.comment;
    comment.resize(k_comment_bytes);
    write(comment);
    const auto count = static_cast<std::uint32_t>(options.triangles);
    write({reinterpret_cast<const char*>(&count), sizeof count});
  }

 private:
  void put(std::span<const Vec3> batch, std::span<const float> /*values*/) override {
    for (const Vec3& p : batch) rounded_.push_back(rounded(p, PositionType::float32));
    kept_.add(rounded_);
    rounded_.clear();
  }

  void put(const TriangleView& batch) override {
    if (!lookup_) lookup_ = std::make_unique<PositionLookup>(kept_);
    char* out = buffer_.data();
    for (const WideTriangle& t : batch.corners) {
      const Vec3 a = lookup_->at(t[0]);
      const Vec3 b = lookup_->at(t[1]);
      const Vec3 c = lookup_->at(t[2]);
      for (const Vec3& p : {normal_of(a, b, c), a, b, c}) out = encode(p, out);
      out = std::fill_n(out, 2, '\0');
    }
    write({buffer_.data(), static_cast<std::size_t>(out - buffer_.data())});
  }

  KeptPositions kept_;
  std::unique_ptr<PositionLookup> lookup_;
  std::vector<Vec3> rounded_;  // of a batch
  std::vector<char> buffer_ = std::vector<char>(k_most_at_once * k_written_facet_bytes);
};

}  // namespace

std::unique_ptr<MeshSink> create_stl(const std::filesystem::path& path,
                                     const MeshSinkOptions& options) {
  return std::make_unique<StlSink>(path, options);
}

}  // namespace meshfarm
