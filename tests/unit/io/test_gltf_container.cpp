// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <unistd.h>

#include "compressed.hpp"
#include "gltf_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

TEST_CASE("compressed GLB and glTF are read") {
  const ReadFile read = read_bytes(gzipped(square_glb()));
  check_square(read);
  CHECK(read.info.compression == "gzip");
  const TempFolder folder;
  write_file(folder / "m.bin", k_square_binary);
  write_file(folder / "m.gltf",
             gzipped(with(k_square_json, "\"byteLength\":60", R"("byteLength":60,"uri":"m.bin")")));
  check_square(read_path(folder / "m.gltf"));
}

TEST_CASE("unknown chunks of a GLB are passed over, and a JSON may begin with a mark") {
  std::string bytes = square_glb();
  const std::size_t json = 20 + (k_square_json.size() + 3) / 4 * 4;
  bytes.insert(json, glb_chunk("????", "abcd", ' '));
  const auto length = static_cast<std::uint32_t>(bytes.size());
  std::memcpy(bytes.data() + 8, &length, sizeof length);
  check_square(read_bytes(bytes));
  check_square(read_glb("\xef\xbb\xbf \n" + k_square_json));
}

TEST_CASE("a GLB that is cut off anywhere is refused") {
  const std::string whole = square_glb();
  const TempFolder folder;
  for (std::size_t length = 4; length < whole.size(); ++length) {
    CHECK_FALSE(refusal(whole.substr(0, length), folder).empty());
  }
  CHECK(refusal(whole.substr(0, 11)) ==
        "m.ply: byte 11: truncated: the header of a GLB has 12 bytes");
  CHECK(refusal(whole.substr(0, 100)) == "m.ply: byte 8: truncated: the header promises " +
                                             std::to_string(whole.size()) +
                                             " bytes, but the file ends at byte 100");
}

TEST_CASE("a GLB with malformed chunks is refused with the byte") {
  const auto refused = [](std::size_t at, std::uint32_t word) {
    std::string bytes = square_glb();
    std::memcpy(bytes.data() + at, &word, sizeof word);
    return refusal(bytes);
  };
  const std::size_t binary = 20 + (k_square_json.size() + 3) / 4 * 4;
  CHECK(refused(4, 1) == "m.ply: byte 4: version 1 of GLB is not 2");
  CHECK(refused(8, 0) == "m.ply: byte 8: the length is less than the header's own");
  CHECK(refused(8, 11) == "m.ply: byte 8: the length is less than the header's own");
  CHECK(refused(8, 15) == "m.ply: byte 12: a chunk's header is cut off");
  CHECK(refused(12, 0xffffffff) ==
        "m.ply: byte 12: a chunk of 4294967295 bytes is longer than what follows");
  CHECK(refused(16, 0x004e4942) == "m.ply: byte 12: the first chunk is not the JSON");
  CHECK(refused(binary, 64) == "m.ply: byte " + std::to_string(binary) +
                                   ": a chunk of 64 bytes is longer than what follows");
  CHECK(refused(binary + 4, 1) ==
        "m.ply: buffers[0] has no uri, and the file no binary chunk for it");
}

TEST_CASE("a GLB that becomes shorter while it is read is refused in a line") {
  const TempFolder folder;
  const std::filesystem::path path = folder / "m.glb";
  write_file(path, square_glb());
  const auto source = open_mesh(path);
  REQUIRE(::truncate(path.c_str(), static_cast<off_t>(square_glb().size() - 40)) == 0);
  CHECK_THROWS_WITH_AS(source->scan_vertices([](std::span<const Vec3>) {}),
                       doctest::Contains("became shorter while it was read"), DataError);
}
