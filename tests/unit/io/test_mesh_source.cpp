// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <support/meshes.hpp>
#include <sys/stat.h>

#include <meshfarm/io/ply_writer.hpp>

#include "compressed.hpp"
#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

std::string torus_bytes() {
  const TempFolder folder;
  write_ply(folder / "torus.ply", torus(150, 200), PositionType::float64);
  return read_file(folder / "torus.ply");
}

/// A handmade zstd frame: no content size, one raw block, no checksum.
std::string raw_zstd(std::string_view content) {
  std::string frame("\x28\xb5\x2f\xfd\x00\x58", 6);
  const std::size_t block = content.size() << 3 | 1;
  for (int i = 0; i < 3; ++i) frame += static_cast<char>(block >> (8 * i) & 0xff);
  return frame + std::string(content);
}

}  // namespace

TEST_CASE("gzip and zstd are told by content") {
  for (const std::string& bytes :
       {ascii_square(), binary_square().text(), binary_square(BinaryFile::Order::big).text()}) {
    const ReadFile from_gzip = read_bytes(gzipped(bytes));
    check_square(from_gzip);
    CHECK(from_gzip.info.compression == "gzip");
    const ReadFile from_zstd = read_bytes(zstandard(bytes));
    check_square(from_zstd);
    CHECK(from_zstd.info.compression == "zstd");
    check_square(read_bytes(raw_zstd(bytes)));
  }
}

TEST_CASE("a compressed mesh longer than the windows is the same mesh") {
  const std::string bytes = torus_bytes();
  const Mesh mesh = read_bytes(bytes).mesh;
  REQUIRE(bytes.size() > 1'400'000);
  for (const std::string& packed : {gzipped(bytes), zstandard(bytes)}) {
    const ReadFile read = read_bytes(packed);
    CHECK(read.mesh.positions == mesh.positions);
    CHECK(read.mesh.triangles == mesh.triangles);
  }
}

TEST_CASE("several members or frames are one file") {
  const std::string bytes = binary_square().text();
  const std::string head = bytes.substr(0, 100), tail = bytes.substr(100);
  check_square(read_bytes(gzipped(head) + gzipped(tail)));
  check_square(read_bytes(zstandard(head) + zstandard(tail)));
  const std::string skippable("\x5a\x2a\x4d\x18\x03\x00\x00\x00xyz", 11);
  check_square(read_bytes(skippable + raw_zstd(head) + skippable + raw_zstd(tail)));
}

TEST_CASE("compressed data cut off at any byte is refused") {
  const std::string bytes = binary_square().text();
  for (const std::string& packed : {gzipped(bytes), zstandard(bytes)}) {
    for (std::size_t size = 1; size < packed.size(); ++size) {
      CAPTURE(size);
      CHECK_FALSE(refusal(packed.substr(0, size)).empty());
    }
  }
}

TEST_CASE("corrupt compressed data is refused or does no harm") {
  const Quiet quiet;
  const std::string bytes = torus_bytes();
  const std::string gzip = gzipped(bytes), zstd = zstandard(bytes);
  std::string bad_sum = gzip;
  bad_sum[bad_sum.size() - 5] ^= 1;
  CHECK(refusal(bad_sum).find("the gzip data is corrupt or truncated") != std::string::npos);
  CHECK(refusal(gzip.substr(0, gzip.size() / 2)).find("the gzip data is corrupt or truncated") !=
        std::string::npos);
  CHECK(refusal(zstd.substr(0, zstd.size() / 2)) ==
        "m.ply: the zstd data is truncated: the frame that starts at byte 0 has no end");
  CHECK(refusal(zstd + "more") ==
        "m.ply: the zstd data is corrupt: no frame starts at byte " + std::to_string(zstd.size()));
  std::string torn = gzip;
  torn[torn.size() / 2] ^= 0x55;
  CHECK_FALSE(refusal(torn).empty());
  const std::string small = binary_square().text();
  for (const std::string& packed : {gzipped(small), zstandard(small)}) {
    for (std::size_t at = 0; at < packed.size(); ++at) {
      std::string changed = packed;
      changed[at] ^= 0x10;
      refusal(changed);
    }
  }
}

TEST_CASE("the checksum of a zstd frame counts") {
  // The output of the command `zstd` for an ascii PLY with the vertex 1 2 3.
  constexpr unsigned char k_frame[] = {
      0x28, 0xb5, 0x2f, 0xfd, 0x24, 0x67, 0x5d, 0x02, 0x00, 0x92, 0x04, 0x10, 0x16, 0x90, 0xb5,
      0x3a, 0x04, 0x02, 0x49, 0xc6, 0x76, 0xbb, 0xb9, 0x65, 0x93, 0xfd, 0xff, 0x9b, 0xf6, 0xaf,
      0xaf, 0xeb, 0x55, 0x79, 0x06, 0x48, 0x78, 0x30, 0x41, 0xbd, 0xc9, 0x9f, 0xc2, 0xac, 0x63,
      0xe0, 0x39, 0x6b, 0x9e, 0xe2, 0xb7, 0xfa, 0xc6, 0xb4, 0x21, 0xb1, 0xfb, 0xea, 0x01, 0xde,
      0x75, 0xf5, 0x74, 0x14, 0x02, 0x62, 0x84, 0xca, 0x91, 0xde, 0x54, 0xca, 0x0c, 0x7c, 0xa9,
      0x05, 0x02, 0x00, 0xa0, 0x13, 0x35, 0xdd, 0x84, 0x02, 0x11, 0xd9, 0xc0, 0xe1};
  std::string frame(std::begin(k_frame), std::end(k_frame));
  CHECK(read_bytes(frame).mesh.positions == std::vector<Vec3>{{1, 2, 3}});
  for (std::size_t missing = 1; missing <= 4; ++missing) {
    CHECK(refusal(frame.substr(0, frame.size() - missing)) ==
          "m.ply: the zstd data is truncated: the frame that starts at byte 0 has no end");
  }
  frame.back() ^= 1;
  CHECK(refusal(frame).find("the zstd data is corrupt or truncated") != std::string::npos);
}

TEST_CASE("a compressed header cannot make us allocate what it claims") {
  for (const auto format : {"ascii", "binary_little_endian"}) {
    const std::string bytes = "ply\nformat " + std::string(format) + " 1.0\n" +
                              mesh_elements(UINT32_MAX, UINT64_MAX) + "end_header\n1 2 3\n4 5 6\n";
    CHECK(refusal(gzipped(bytes)).find("truncated") != std::string::npos);
    CHECK(refusal(zstandard(bytes)).find("truncated") != std::string::npos);
  }
  BinaryFile file(BinaryFile::Order::little,
                  replaced(mesh_elements(1, 1), "uchar int", "uint64 int"));
  file.floats({0, 0, 0}).put<std::uint64_t>({UINT64_MAX}).ints({0, 0, 0});
  CHECK(refusal(gzipped(file.text())).find("inside face 0 of 1") != std::string::npos);
}

TEST_CASE("unknown formats are refused with what is supported") {
  const std::string why =
      "m.ply: unknown format; meshfarm reads PLY, GLB, glTF, OFF, OBJ and STL, plain or compressed "
      "with gzip "
      "or zstd";
  for (const auto text :
       {"\n\n", "vertex 0 0 0\n", "v\n", "solid x\n", "solid x\nsurface\n", "OFFICE 1\n",
        "off\n0 0 0\n", "plying\n", "PLY\n", " ply\n", "p", "\x1f", "\x28\xb5\x2f"}) {
    CHECK(refusal(text) == why);
  }
  CHECK(refusal(gzipped("V 0 0 0\n")) == why);
  CHECK(refusal(zstandard("")) == why);
  CHECK(refusal("") == "m.ply: is empty");
}

TEST_CASE("what is no readable file is refused") {
  const TempFolder folder;
  CHECK_THROWS_AS(open_mesh(folder / "none.ply"), IoError);
  CHECK_THROWS_AS(open_mesh(folder.path()), IoError);
  CHECK_THROWS_AS(open_mesh("/dev/null"), DataError);
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  CHECK_THROWS_AS(open_mesh(folder / "pipe"), DataError);
}

TEST_CASE("a source can be scanned as often as wanted, in bounded batches") {
  const TempFolder folder;
  const std::string bytes = torus_bytes();
  write_file(folder / "m.ply", bytes);
  write_file(folder / "m.gz", gzipped(bytes));
  for (const auto name : {"m.ply", "m.gz"}) {
    const auto source = open_mesh(folder / name);
    for (int pass = 0; pass < 2; ++pass) {
      std::size_t triangles = 0, vertices = 0, largest = 0;
      source->scan_triangles([&](std::span<const WideTriangle> batch) {
        triangles += batch.size();
        largest = std::max(largest, batch.size());
      });
      source->scan_vertices([&](std::span<const Vec3> batch) {
        vertices += batch.size();
        largest = std::max(largest, batch.size());
      });
      CHECK(vertices == 30'000);
      CHECK(triangles == 60'000);
      CHECK(largest <= 65'536);
    }
  }
}

TEST_CASE("scans in any order give the same, wherever the faces stand") {
  const std::string faces = "element face 2\n" + std::string(k_corners);
  const std::string vertices = "element vertex 4\n" + std::string(k_xyz);
  const std::string corners = "3 0 1 2\n3 2 1 3\n";
  const std::string first = "ply\nformat ascii 1.0\n";
  const std::string points(k_square_text);
  const TempFolder folder;
  for (const std::string& text : {ascii_square(), binary_square().text(),
                                  first + faces + vertices + "end_header\n" + corners + points,
                                  first + "element extra 1\nproperty int a\n" + vertices +
                                      "element more 1\nproperty int a\n" + faces +
                                      "end_header\n5\n" + points + "6\n" + corners}) {
    for (const std::string& bytes : {text, gzipped(text)}) {
      write_file(folder / "m.ply", bytes);
      for (const std::string_view scans : {"vvt", "vtvt", "tvtt", "vvvv", "ttvvtt"}) {
        CAPTURE(scans);
        const auto source = open_mesh(folder / "m.ply");
        for (const char scan : scans) {
          std::vector<Vec3> positions;
          std::vector<WideTriangle> triangles;
          if (scan == 'v') {
            source->scan_vertices([&](std::span<const Vec3> batch) {
              positions.insert(positions.end(), batch.begin(), batch.end());
            });
            CHECK(positions == k_square_vertices);
          } else {
            source->scan_triangles([&](std::span<const WideTriangle> batch) {
              triangles.insert(triangles.end(), batch.begin(), batch.end());
            });
            CHECK(triangles == std::vector<WideTriangle>{{0, 1, 2}, {2, 1, 3}});
          }
        }
      }
    }
  }
}

TEST_CASE("an exception of the taker ends the scan and leaves the source usable") {
  const TempFolder folder;
  write_file(folder / "m.ply", ascii_square());
  const auto source = open_mesh(folder / "m.ply");
  CHECK_THROWS_AS(source->scan_vertices([](std::span<const Vec3>) { throw 7; }), int);
  CHECK(read_mesh(*source).positions == k_square_vertices);
}

TEST_CASE("vertices of a plain binary file are jumped over") {
  // Positions are only checked when they are asked for: these are invalid.
  BinaryFile file(BinaryFile::Order::little, mesh_elements(4, 1));
  file.put<std::uint32_t>(std::initializer_list<std::uint32_t>{~0U, ~0U, ~0U, ~0U, ~0U, ~0U, ~0U,
                                                               ~0U, ~0U, ~0U, ~0U, ~0U});
  file.bytes({3}).ints({0, 1, 2});
  const TempFolder folder;
  write_file(folder / "m.ply", file.text());
  const auto source = open_mesh(folder / "m.ply");
  std::size_t triangles = 0;
  source->scan_triangles([&](std::span<const WideTriangle> batch) { triangles += batch.size(); });
  CHECK(triangles == 1);
  source->scan_vertices([](std::span<const Vec3> batch) {
    for (const Vec3& p : batch) CHECK_FALSE(has_position(p));
  });
  CHECK(read_mesh(*source).triangles.empty());
}

TEST_CASE("a file that becomes shorter while it is read is an error, plain or compressed") {
  const std::string bytes = torus_bytes();
  for (const std::string& packed : {bytes, gzipped(bytes), zstandard(bytes)}) {
    const TempFolder folder;
    const std::filesystem::path path = folder / "m.ply";
    write_file(path, packed);
    const auto source = open_mesh(path);
    const auto shrink = [&](std::span<const Vec3>) {
      std::filesystem::resize_file(path, packed.size() / 8);
    };
    try {
      source->scan_vertices(shrink);
      source->scan_triangles([](std::span<const WideTriangle>) {});
      FAIL("it was read");
    } catch (const DataError& error) {
      CHECK(std::string(error.what()).find("became shorter while it was read") !=
            std::string::npos);
    }
  }
}

TEST_CASE("a mesh of 2^32 vertices is not read into memory") {
  struct Huge : MeshSource {
    MeshFileInfo huge;
    const MeshFileInfo& info() const override { return huge; }
    void scan_vertices(const std::function<void(std::span<const Vec3>)>&) override { FAIL("read"); }
    void scan_triangles(const std::function<void(const TriangleView&)>&) override {}
  } source;
  source.huge.vertices = std::uint64_t{1} << 32;
  CHECK_THROWS_AS(read_mesh(source), DataError);
}
