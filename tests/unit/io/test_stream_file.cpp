// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>

#include <doctest/doctest.h>

#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

constexpr std::size_t k_head_bytes = 37 + 8;

/// A sheet in sweep order: its vertices and triangles come row by row. The vertices of the first
/// and last row are boundary vertices.
StreamMesh sheet(std::uint32_t columns, std::uint32_t rows) {
  StreamMesh stream;
  stream.mesh = test::grid(columns, rows);
  stream.positions = PositionType::float64;
  for (const Vec3& p : stream.mesh.positions) {
    stream.boundary.push_back(p.y == 0 || p.y == rows ? 1 : 0);
  }
  return stream;
}

/// Two triangles, 1 2 3 and 2 5 3, and two boundary vertices that none uses: 0 and 4. One block.
StreamMesh tiny() {
  StreamMesh stream;
  stream.mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 2, 0}};
  stream.mesh.triangles = {{1, 2, 3}, {2, 5, 3}};
  stream.boundary = {1, 0, 0, 0, 1, 0};
  stream.positions = PositionType::float64;
  return stream;
}

struct ReadBack {
  StreamInfo info;
  Mesh mesh;
  std::vector<std::uint32_t> boundary;
  std::vector<std::uint32_t> finished;  // in the order of finalisation
  std::size_t blocks = 0;
};

ReadBack read_back(const std::string& file) {
  StreamReader reader(fill_from(file, "stream"), "stream");
  ReadBack read;
  read.info = reader.info();
  StreamBlock block;
  while (reader.next(block)) {
    ++read.blocks;
    const auto first = static_cast<std::uint32_t>(read.mesh.positions.size());
    for (const StreamCorner corner : block.boundary) {
      read.boundary.push_back(first + corner.vertex());
      if (corner.last_use()) read.finished.push_back(first + corner.vertex());
    }
    read.mesh.positions.insert(read.mesh.positions.end(), block.positions.begin(),
                               block.positions.end());
    for (const auto& t : block.triangles) {
      read.mesh.triangles.push_back({t[0].vertex(), t[1].vertex(), t[2].vertex()});
      for (const StreamCorner corner : t) {
        REQUIRE(corner.vertex() < read.mesh.positions.size());
        if (corner.last_use()) read.finished.push_back(corner.vertex());
      }
    }
  }
  return read;
}

/// The error with which the reader refuses the file; empty if it accepts it.
std::string stream_refusal(const std::string& file) {
  try {
    read_back(file);
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

/// Writes valid checksums into a stream of one block after a change.
std::string resealed(std::string file) {
  const auto put = [&](std::size_t at, std::uint64_t sum) {
    std::memcpy(file.data() + at, &sum, sizeof sum);
  };
  const std::uint64_t head = checksum(std::string_view(file).substr(0, 37));
  put(37, head);
  std::string chained(reinterpret_cast<const char*>(&head), sizeof head);
  chained += file.substr(k_head_bytes, file.size() - k_head_bytes - 8);
  put(file.size() - 8, checksum(chained));
  return file;
}

/// The file of tiny() with `value` at `offset` bytes from the start of its only block.
std::string tiny_with(std::size_t offset, std::uint32_t value) {
  std::string file = encode_stream(tiny());
  std::memcpy(file.data() + k_head_bytes + offset, &value, sizeof value);
  return resealed(file);
}

constexpr std::size_t k_boundary_at = 12 + 6 * 24;
constexpr std::size_t k_corners_at = k_boundary_at + 2 * 4;

}  // namespace

TEST_CASE("a stream comes back whole, over many blocks") {
  const StreamMesh stream = sheet(300, 120);
  const ReadBack read = read_back(encode_stream(stream));
  CHECK(read.blocks > 3);
  CHECK(read.info.vertices == 301 * 121);
  CHECK(read.info.triangles == 72'000);
  CHECK(read.info.boundary_vertices == 602);
  CHECK(read.mesh.positions == stream.mesh.positions);
  CHECK(read.mesh.triangles == stream.mesh.triangles);
  CHECK(read.boundary.size() == 602);
  CHECK(std::all_of(read.boundary.begin(), read.boundary.end(),
                    [&](std::uint32_t v) { return stream.boundary[v] == 1; }));
}

TEST_CASE("every vertex is finalised once, and a sheet's rows one after the other") {
  const ReadBack read = read_back(encode_stream(sheet(50, 400)));
  std::vector<std::uint32_t> sorted = read.finished;
  std::sort(sorted.begin(), sorted.end());
  REQUIRE(sorted.size() == read.mesh.positions.size());
  for (std::uint32_t v = 0; v < sorted.size(); ++v) REQUIRE(sorted[v] == v);
  for (std::size_t i = 0; i < read.finished.size(); ++i) {
    REQUIRE(read.finished[i] < i + 2 * 51);  // none is finalised much later than its turn
  }
}

TEST_CASE("boundary vertices without triangles are in the stream, too") {
  const ReadBack read = read_back(encode_stream(tiny()));
  CHECK(read.mesh.triangles == tiny().mesh.triangles);
  CHECK(read.boundary == std::vector<std::uint32_t>{0, 4});
  CHECK(read.finished.size() == 6);
}

TEST_CASE("triangles that reach far ahead are preceded by blocks of vertices") {
  StreamMesh stream;
  stream.mesh.positions.resize(200'000);
  for (std::uint32_t i = 0; i < 200'000; ++i) stream.mesh.positions[i] = {1.0 * i, 0, 0};
  stream.mesh.triangles = {{0, 1, 199'999}};
  stream.boundary.assign(200'000, 1);
  const ReadBack read = read_back(encode_stream(stream));
  CHECK(read.mesh.triangles == stream.mesh.triangles);
  CHECK(read.blocks == 4);
}

TEST_CASE("an empty stream") {
  const ReadBack read = read_back(encode_stream({}));
  CHECK(read.blocks == 0);
  CHECK(read.info.vertices == 0);
}

TEST_CASE("a stream read as a part has its boundary vertices first") {
  const StreamMesh stream = sheet(7, 5);
  const std::string file = encode_stream(stream);
  StreamReader reader(fill_from(file, "stream"), "stream");
  const Part part = read_stream(reader);
  CHECK(part.boundary_vertices == 16);
  CHECK(part.mesh.positions.size() == 48);
  for (std::uint32_t v = 0; v < 48; ++v) {
    const double y = part.mesh.positions[v].y;
    CHECK((v < 16) == (y == 0 || y == 5));
  }
  REQUIRE(part.mesh.triangles.size() == stream.mesh.triangles.size());
  for (std::size_t i = 0; i < part.mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(part.mesh.positions[part.mesh.triangles[i][k]] ==
            stream.mesh.positions[stream.mesh.triangles[i][k]]);
    }
  }
}

TEST_CASE("any cut and any flipped byte is refused, and the place is told") {
  const std::string file = encode_stream(sheet(9, 9));
  for (std::size_t size = 0; size < file.size(); ++size) {
    CAPTURE(size);
    REQUIRE(stream_refusal(file.substr(0, size)).find("cut short at byte") != std::string::npos);
  }
  for (std::size_t at = 0; at < file.size(); ++at) {
    CAPTURE(at);
    std::string damaged = file;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    REQUIRE_FALSE(stream_refusal(damaged).empty());
  }
  const std::string large = encode_stream(sheet(300, 120));
  std::string damaged = large;
  damaged[large.size() / 2] = static_cast<char>(damaged[large.size() / 2] ^ 1);
  CHECK(stream_refusal(damaged) == "stream: block 2: damaged (checksum)");
}

TEST_CASE("what the checksums cannot tell is refused with the place") {
  const auto corner = [](std::uint32_t number) { return k_corners_at + 4 * number; };
  CHECK(
      stream_refusal(tiny_with(corner(0), 1 << 1 | 1)).empty());  // the helper changes nothing else
  CHECK(stream_refusal(tiny_with(corner(1), 2 << 1 | 1)) ==
        "stream: block 0: triangle 1 uses vertex 2, which was finalised before");
  CHECK(stream_refusal(tiny_with(corner(0), 0 << 1)) ==
        "stream: block 0: triangle 0 uses vertex 0, which was finalised before");
  CHECK(stream_refusal(tiny_with(corner(3), 6 << 1)) ==
        "stream: block 0: triangle 1 uses vertex 6, which is not there yet");
  CHECK(stream_refusal(tiny_with(corner(4), 5 << 1)) ==
        "stream: block 1: 1 vertices are never finalised");
  CHECK(stream_refusal(tiny_with(k_boundary_at, 0 << 1)) ==
        "stream: block 1: 1 vertices are never finalised");
  CHECK(stream_refusal(tiny_with(k_boundary_at + 4, 6 << 1)) ==
        "stream: block 0: boundary vertices out of order");
  CHECK(stream_refusal(tiny_with(k_boundary_at + 4, 0 << 1)) ==
        "stream: block 0: boundary vertices out of order");
}

TEST_CASE("counts that cannot be are refused before anything is made of them") {
  CHECK(stream_refusal(tiny_with(0, 0xffffffff)).find("impossible counts") != std::string::npos);
  CHECK(stream_refusal(tiny_with(8, 60'000)).find("more than the head") != std::string::npos);
  std::string file = encode_stream(tiny());
  file[16] = 3;
  CHECK(stream_refusal(resealed(file)).find("unknown kind of positions") != std::string::npos);
  file = encode_stream(tiny());
  file[8] = 9;
  CHECK(stream_refusal(resealed(file)).find("unknown version") != std::string::npos);
}

TEST_CASE("a stream's appearances come back") {
  StreamMesh stream = sheet(300, 200);
  stream.mesh.appearances = test::appearances(stream.mesh.positions.size());
  const std::string file = encode_stream(stream);
  StreamReader whole(fill_from(file, "stream"), "stream");
  CHECK(whole.info().appearances);
  CHECK(read_stream_mesh(whole).mesh.appearances == stream.mesh.appearances);
  // Read as a part: boundary vertices come first.
  StreamReader reader(fill_from(file, "stream"), "stream");
  const Part part = read_stream(reader);
  REQUIRE(part.mesh.appearances.size() == part.mesh.positions.size());
  for (std::size_t v = 0; v < part.mesh.positions.size(); ++v) {
    const Vec3 p = part.mesh.positions[v];
    const auto was = static_cast<std::size_t>(p.y * 301 + p.x);
    REQUIRE(part.mesh.appearances[v] == stream.mesh.appearances[was]);
  }
}
