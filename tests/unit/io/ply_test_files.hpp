// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <support/temp_folder.hpp>
#include <unistd.h>

#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm::test {

inline void write_file(const std::filesystem::path& path, std::string_view bytes) {
  const Fd fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  REQUIRE(fd);
  write_all(fd.get(), bytes, path);
}

/// The bytes of a binary file, in either byte order.
class BinaryFile {
 public:
  enum class Order { little, big };

  BinaryFile(Order order, std::string_view elements) : order_(order) {
    bytes_ = "ply\nformat binary_";
    bytes_ += order == Order::little ? "little" : "big";
    bytes_ += "_endian 1.0\n" + std::string(elements) + "end_header\n";
    header_bytes_ = bytes_.size();
  }
  template <class T>
  BinaryFile& put(std::initializer_list<T> values) {
    for (T value : values) {
      char raw[sizeof(T)];
      std::memcpy(raw, &value, sizeof(T));
      if (order_ == Order::big) std::reverse(raw, raw + sizeof(T));
      bytes_.append(raw, sizeof(T));
    }
    return *this;
  }
  BinaryFile& floats(std::initializer_list<float> values) { return put(values); }
  BinaryFile& ints(std::initializer_list<std::int32_t> values) { return put(values); }
  BinaryFile& bytes(std::initializer_list<std::uint8_t> values) { return put(values); }
  const std::string& text() const { return bytes_; }
  std::size_t header_bytes() const { return header_bytes_; }

 private:
  Order order_;
  std::string bytes_;
  std::size_t header_bytes_ = 0;
};

/// The result of reading a whole file.
struct ReadFile {
  MeshFileInfo info;
  Mesh mesh;
  std::uint64_t small_faces = 0;
};

inline ReadFile read_path(const std::filesystem::path& path) {
  const std::unique_ptr<MeshSource> source = open_mesh(path);
  ReadFile result{{}, read_mesh(*source), 0};
  result.info = source->info();
  result.small_faces = source->small_faces();
  return result;
}

inline ReadFile read_bytes(std::string_view bytes) {
  const TempFolder folder;
  write_file(folder / "m.ply", bytes);
  return read_path(folder / "m.ply");
}

/// The message with which reading the bytes is refused, without the folder's name; empty if they
/// are read.
inline std::string refusal(std::string_view bytes, const TempFolder& folder) {
  write_file(folder / "m.ply", bytes);
  try {
    read_path(folder / "m.ply");
    return "";
  } catch (const DataError& error) {
    std::string message = error.what();
    CHECK(message.find('\n') == std::string::npos);
    const std::string where = folder.path().string() + "/";
    REQUIRE(message.starts_with(where));
    return message.substr(where.size());
  }
}

inline std::string refusal(std::string_view bytes) {
  return refusal(bytes, TempFolder());
}

/// Suppresses warnings during its lifetime.
struct Quiet {
  Quiet() { set_log("", LogLevel::off); }
  ~Quiet() { set_log("", LogLevel::info); }
};

/// What `run` writes to stderr.
template <class Run>
std::string stderr_of(Run&& run) {
  const TempFolder folder;
  const std::filesystem::path path = folder / "stderr";
  std::fflush(stderr);
  const Fd kept(::dup(STDERR_FILENO));
  {
    const Fd file(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644));
    ::dup2(file.get(), STDERR_FILENO);
  }
  run();
  std::fflush(stderr);
  ::dup2(kept.get(), STDERR_FILENO);
  return read_file(path);
}

constexpr std::string_view k_xyz = "property float x\nproperty float y\nproperty float z\n";
constexpr std::string_view k_corners = "property list uchar int vertex_indices\n";

/// The elements of a header: vertices of three floats, faces of int lists.
inline std::string mesh_elements(std::uint64_t vertices, std::uint64_t faces) {
  return "element vertex " + std::to_string(vertices) + "\n" + std::string(k_xyz) +
         "element face " + std::to_string(faces) + "\n" + std::string(k_corners);
}

///   2---3
///   | \ |   Four vertices, two triangles (0 1 2), (2 1 3).
///   0---1
inline const std::vector<Vec3> k_square_vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5}};
inline const std::vector<Triangle> k_square_triangles{{0, 1, 2}, {2, 1, 3}};
constexpr std::string_view k_square_text = "0 0 0\n1 0 0\n0 1 0\n1 1 0.5\n";

inline std::string ascii_square(std::string_view faces = "3 0 1 2\n3 2 1 3\n") {
  const auto lines = std::count(faces.begin(), faces.end(), '\n');
  return "ply\nformat ascii 1.0\n" + mesh_elements(4, static_cast<std::uint64_t>(lines)) +
         "end_header\n" + std::string(k_square_text) + std::string(faces);
}

inline BinaryFile binary_square(BinaryFile::Order order = BinaryFile::Order::little) {
  BinaryFile file(order, mesh_elements(4, 2));
  file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5F});
  file.bytes({3}).ints({0, 1, 2}).bytes({3}).ints({2, 1, 3});
  return file;
}

inline void check_square(const ReadFile& read) {
  CHECK(read.info.vertices == 4);
  CHECK(read.mesh.positions == k_square_vertices);
  CHECK(read.mesh.triangles == k_square_triangles);
}

inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace meshfarm::test
