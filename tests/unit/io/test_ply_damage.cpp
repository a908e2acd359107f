// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Whatever is done to a file, reading it gives a mesh or throws an Error: no crash, no hang, and no
// memory for what a header merely claims.
#include <doctest/doctest.h>

#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

using Order = BinaryFile::Order;

/// A file with every kind of element and list, in this byte order.
std::string rich_file(Order order) {
  BinaryFile file(order,
                  "comment made by hand\nelement pad 1\nproperty list uchar short bits\n"
                  "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                  "property uchar red\n"
                  "element face 3\nproperty list uchar int vertex_indices\n"
                  "element tristrips 1\nproperty list int int vertex_indices\n"
                  "element tail 2\nproperty double d\n");
  file.bytes({2}).put<short>({1, 2});
  for (const float i : {0.F, 1.F, 2.F, 3.F}) file.floats({i, 1, i}).bytes({7});
  file.bytes({3}).ints({0, 1, 2}).bytes({4}).ints({0, 1, 3, 2}).bytes({3}).ints({2, 1, 3});
  file.ints({5, 0, 1, 2, -1, 3});
  file.put<double>({1, 2});
  return file.text();
}

std::string header_claiming(std::string_view format, std::string_view vertices,
                            std::string_view faces) {
  return "ply\nformat " + std::string(format) + " 1.0\nelement vertex " + std::string(vertices) +
         "\n" + std::string(k_xyz) + "element face " + std::string(faces) + "\n" +
         std::string(k_corners) + "end_header\n";
}

constexpr const char* k_most = "18446744073709551615";

}  // namespace

TEST_CASE("a binary file cut off at any byte is refused") {
  const Quiet quiet;
  const TempFolder folder;
  for (const Order order : {Order::little, Order::big}) {
    const std::string whole = rich_file(order);
    CHECK(refusal(whole).empty());
    for (std::size_t size = 1; size < whole.size(); ++size) {
      CAPTURE(size);
      CHECK_FALSE(refusal(whole.substr(0, size), folder).empty());
    }
  }
}

TEST_CASE(
    "an ascii file cut off at any byte is refused, or has lost digits of its last value only") {
  const Quiet quiet;
  const TempFolder folder;
  const std::string whole = ascii_square();
  const std::size_t last_value = whole.rfind(' ') + 2;
  for (std::size_t size = 1; size < whole.size(); ++size) {
    CAPTURE(size);
    CHECK(refusal(whole.substr(0, size), folder).empty() == (size >= last_value));
  }
}

TEST_CASE("a truncated file is told from where it ends") {
  const std::string whole = binary_square().text();
  const auto cut = [&whole](std::size_t bytes) {
    return refusal(whole.substr(0, whole.size() - bytes));
  };
  const auto end = [&whole](std::size_t bytes) { return std::to_string(whole.size() - bytes); };
  CHECK(cut(4) == "m.ply: face 1 at byte " + end(13) +
                      ": list vertex_indices claims 3 items, but only 8 bytes follow");
  CHECK(cut(13) == "m.ply: truncated: the file ends at byte " + end(13) + ", inside face 1 of 2");
  const std::string wrong = "m.ply: truncated, or the header is wrong: it claims ";
  CHECK(cut(25) == wrong +
                       "2 records of element face of 1 bytes or more, but the file ends at byte " +
                       end(25) + ", in face 1 at the latest");
  CHECK(cut(40) == wrong + "4 records of element vertex of 12 bytes, but the file ends at byte " +
                       end(40) + ", in vertex 2 at the latest");
  CHECK(refusal(ascii_square("3 0 1 2\n3 2 1 3\n").substr(0, ascii_square().size() - 8)) ==
        "m.ply: truncated: the file ends on line 15, before face 1 of 2");
}

TEST_CASE("counts up to 2^64 - 1 are refused at once") {
  for (const auto format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    CHECK(refusal(header_claiming(format, k_most, "0"))
              .starts_with("m.ply: truncated, or the header is wrong: it claims "
                           "18446744073709551615 records of element vertex of "));
    CHECK(refusal(header_claiming(format, "0", k_most))
              .starts_with("m.ply: truncated, or the header is wrong: it claims "
                           "18446744073709551615 records of element face of "));
    CHECK(refusal(header_claiming(format, "1537228672809129302", "1"))  // 2^64 / 12, and one more
              .starts_with("m.ply: truncated, or the header is wrong: it claims "));
  }
}

TEST_CASE("an element without properties takes no time, however often it claims to occur") {
  const std::string nothing = "element nothing " + std::string(k_most) + "\nelement vertex";
  check_square(read_bytes(replaced(ascii_square(), "element vertex", nothing)));
  check_square(read_bytes(replaced(binary_square().text(), "element vertex", nothing)));
}

TEST_CASE("any byte changed to any other") {
  const Quiet quiet;
  const TempFolder folder;
  std::size_t read = 0;
  for (const std::string& whole :
       {rich_file(Order::little), rich_file(Order::big), ascii_square("3 0 1 2\n4 2 1 3 0\n")}) {
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (const char change : {'\x00', '\x01', '\x7f', '\x80', '\xff', '\n', '-', '9'}) {
        std::string bytes = whole;
        bytes[at] = change;
        read += refusal(bytes, folder).empty();
      }
    }
  }
  CHECK(read > 1000);  // coordinates and comments may change without harm
}
