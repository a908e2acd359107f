// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <filesystem>
#include <locale>

#include <doctest/doctest.h>

#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

std::string one_vertex(std::string_view type, std::string_view line) {
  const std::string property = "property " + std::string(type) + " ";
  return "ply\nformat ascii 1.0\nelement vertex 1\n" + property + "x\n" + property + "y\n" +
         property + "z\nend_header\n" + std::string(line) + "\n";
}

std::vector<Triangle> ply_triangles(std::string_view faces) {
  return read_bytes(ascii_square(faces)).mesh.triangles;
}

/// The outcome of reading a file with some number of threads: mesh and warnings, or an error.
struct ByThreads {
  Mesh mesh;
  PositionType positions = PositionType::float32;
  std::string error;
};

ByThreads read_ply_by(unsigned threads, std::string_view bytes) {
  const TempFolder folder;
  write_file(folder / "m.ply", bytes);
  ByThreads made;
  try {
    const auto source = open_mesh(folder / "m.ply", {.threads = threads});
    made.mesh = read_mesh(*source);
    made.positions = source->info().positions;
  } catch (const DataError& error) {
    made.error = std::string(error.what()).substr(folder.path().string().size());
  }
  return made;
}

std::string strips(std::string_view indices) {
  return "ply\nformat ascii 1.0\nelement vertex 4\n" + std::string(k_xyz) +
         "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
         std::string(k_square_text) + std::string(indices) + "\n";
}

}  // namespace

TEST_CASE("ascii numbers of every notation") {
  const auto x = [](std::string_view type, std::string_view number) {
    return read_bytes(one_vertex(type, std::string(number) + " 0 0")).mesh.positions.at(0).x;
  };
  CHECK(x("float", "1.5") == 1.5);
  CHECK(x("float", "+1.5") == 1.5);
  CHECK(x("float", "-.5") == -0.5);
  CHECK(x("float", "5.") == 5);
  CHECK(x("float", "1e2") == 100);
  CHECK(x("float", "-1.25E-2") == static_cast<double>(-1.25e-2F));
  CHECK(x("float", "0.1") == static_cast<double>(0.1F));
  CHECK(x("double", "0.1") == 0.1);
  CHECK(x("float", "1e-60") == 0);
  CHECK(x("float", "0." + std::string(60, '0') + "1") == 0);
  CHECK(x("double", "-1e-400") == 0);
  CHECK(x("double", "0." + std::string(200, '0') + "1e-200") == 0);
  CHECK(x("double", "1e-99999999999999999999") == 0);
  CHECK(x("int", "-2147483648") == -2147483648.0);
  CHECK(x("uint64", "18446744073709549568") == 18446744073709549568.0);
  CHECK(x("char", "-128") == -128);
}

TEST_CASE("an ascii vertex with a coordinate that is not finite has no position") {
  const auto has = [](std::string_view type, std::string_view number) {
    const ReadFile read = read_bytes(one_vertex(type, "0 " + std::string(number) + " 0"));
    REQUIRE(read.mesh.positions.size() == 1);
    return has_position(read.mesh.positions[0]);
  };
  for (const auto number : {"nan", "NaN", "inf", "-inf", "+inf", "infinity", "1e39", "1e9999"}) {
    CHECK_FALSE(has("float", number));
  }
  CHECK_FALSE(has("float", "1" + std::string(60, '0') + "e-10"));
  CHECK_FALSE(has("double", "-1e309"));
  CHECK_FALSE(has("double", "1e99999999999999999999"));
  CHECK(has("double", "1e39"));
}

TEST_CASE("ascii values that are no number are refused with their line") {
  const auto told = [](std::string_view type, std::string_view number) {
    return refusal(one_vertex(type, "0 " + std::string(number) + " 0"));
  };
  const std::string at = "m.ply: vertex 0 on line 8: ";
  CHECK(told("float", "abc") == at + "the coordinate 'abc' is no number of type float");
  CHECK(told("float", "1,5") == at + "the coordinate '1,5' is no number of type float");
  CHECK(told("float", "1.#INF") == at + "the coordinate '1.#INF' is no number of type float");
  CHECK(told("float", "+-1") == at + "the coordinate '+-1' is no number of type float");
  CHECK(told("float", "0x10") == at + "the coordinate '0x10' is no number of type float");
  CHECK(told("float", std::string_view("1\0", 2)) ==
        at + "the coordinate '1?' is no number of type float");
  CHECK(told("int", "1.5") == at + "the coordinate '1.5' is no number of type int");
  CHECK(told("uchar", "256") == at + "the coordinate '256' is no number of type uchar");
  CHECK(told("uchar", "-1") == at + "the coordinate '-1' is no number of type uchar");
  CHECK(told("float", "0." + std::string(300, '1')).find("is no number of type float") !=
        std::string::npos);
}

TEST_CASE("numbers do not depend on the locale") {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
  const ReadFile read = read_bytes(one_vertex("double", "0.5 1.5 2.5"));
  std::locale::global(before);
  CHECK(read.mesh.positions == std::vector<Vec3>{{0.5, 1.5, 2.5}});
}

TEST_CASE("convex polygons become fans; strips their triangles") {
  CHECK(ply_triangles("4 0 1 3 2\n") == std::vector<Triangle>{{0, 1, 3}, {0, 3, 2}});
  const auto of_strips = [](std::string_view indices) {
    return read_bytes(strips(indices)).mesh.triangles;
  };
  CHECK(of_strips("4 0 1 2 3") == std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}});
  CHECK(of_strips("9 0 1 2 3 -1 0 1 2 -1") ==
        std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {0, 1, 2}});
  CHECK(of_strips("8 0 1 2 -1 -1 1 3 2") == std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}});
  CHECK(of_strips("7 0 1 2 2 2 1 3") == std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}});
  CHECK(of_strips("2 0 1").empty());
  CHECK(of_strips("0").empty());
  CHECK(refusal(strips("3 0 1 -2")) ==
        "m.ply: tristrips 0 on line 14: vertex index -2 is out of range: there are 4 vertices");
}

TEST_CASE("faces of fewer than three corners are left out and counted") {
  const ReadFile read = read_bytes(ascii_square("3 0 1 2\n2 0 1\n0\n1 3\n3 2 1 3\n"));
  check_square(read);
  CHECK(read.info.faces == 5);
  CHECK(read.small_faces == 3);
}

TEST_CASE("indices out of range are refused with face and line") {
  const std::string at = "m.ply: face 1 on line 15: vertex index ";
  CHECK(refusal(ascii_square("3 0 1 2\n3 2 1 4\n")) ==
        at + "4 is out of range: there are 4 vertices");
  CHECK(refusal(ascii_square("3 0 1 2\n3 2 -1 3\n")) ==
        at + "-1 is out of range: there are 4 vertices");
  CHECK(refusal(ascii_square("3 0 1 2\n3 2 1 99999999999999999999\n")).starts_with(at));
  CHECK(refusal(ascii_square("3 0 1 2\n2 2 7\n")).starts_with(at));
  CHECK(refusal(ascii_square("3 0 1 2\n3 2 1 x\n")) ==
        "m.ply: face 1 on line 15: the vertex index 'x' is not a whole number");
  CHECK(refusal(ascii_square("3 0 1 2\n3 2 1 3.0\n")) ==
        "m.ply: face 1 on line 15: the vertex index '3.0' is not a whole number");
}

TEST_CASE("float indices are taken as long as they are whole") {
  const std::string bytes =
      replaced(ascii_square("3.0 0 1.0 2e0\n3 2 1 3\n"), "list uchar int", "list float double");
  check_square(read_bytes(bytes));
  CHECK(refusal(replaced(bytes, "2e0", "1.5")) ==
        "m.ply: face 0 on line 14: the vertex index '1.5' is not a whole number");
  CHECK(refusal(replaced(bytes, "3.0 0", "2.5 0")) ==
        "m.ply: face 0 on line 14: list vertex_indices has the count '2.5', which is not a whole "
        "number");
}

TEST_CASE("list counts are checked") {
  CHECK(refusal(ascii_square("3 0 1 2\n-1 2 1 3\n")) ==
        "m.ply: face 1 on line 15: list vertex_indices has a count below zero");
  CHECK(refusal(ascii_square("3 0 1 2\n4 2 1 3\n")) ==
        "m.ply: face 1 on line 15: the line ends before its last value");
  CHECK(refusal(ascii_square("3 0 1 2\n9223372036854775807 2 1 3\n")) ==
        "m.ply: face 1 on line 15: the line ends before its last value");
}

TEST_CASE("ascii floats with more digits than a float holds are doubles") {
  const auto read = [](std::string_view numbers) {
    return read_bytes(one_vertex("float", std::string(numbers)));
  };
  const ReadFile utm = read("500123.45 5412345.678 312.25");
  CHECK(utm.info.positions == PositionType::float64);
  CHECK(utm.mesh.positions == std::vector<Vec3>{{500123.45, 5412345.678, 312.25}});
  CHECK(read("0.123456789 0 0").info.positions == PositionType::float64);
  CHECK(read("1.23456789e-05 0 0").info.positions == PositionType::float64);
  CHECK(read("123456789 0 0").info.positions == PositionType::float64);
  // Floats, printed in various ways.
  for (const auto numbers :
       {"0.1 0.100000001 0.10000000149011612", "-0.0312216 0.00514924 1e-7",
        "500123.4 500123.437500 5.0012344e+05", "3.141593 16777217e-3 1.17549435e-38",
        "16777216 9999999 -1e-50", "1e39 nan 0.333333343",
        "0.38476562 -0.37695312 0.46679688"}) {  // of nine digits, the last of which is a 5
    CAPTURE(numbers);
    CHECK(read(numbers).info.positions == PositionType::float32);
  }
}

TEST_CASE(
    "one late value with many digits is enough, and no scan is left with the others rounded") {
  const TempFolder folder;
  constexpr std::size_t k_count = 20'000;
  std::string text = "ply\nformat ascii 1.0\n" + mesh_elements(k_count, 1) + "end_header\n";
  text += "0.12345675 1 0\n";
  for (std::size_t i = 2; i < k_count; ++i) text += "0 1 0\n";
  write_file(folder / "m.ply", text + "1 1 1234567.1234\n3 0 1 2\n");
  const auto source = open_mesh(folder / "m.ply");
  CHECK(source->info().positions == PositionType::float32);
  const Mesh mesh = read_mesh(*source);
  CHECK(source->info().positions == PositionType::float64);
  CHECK(mesh.positions.front().x == 0.12345675);
  CHECK(mesh.positions.back().z == 1234567.1234);
  CHECK(mesh.triangles.size() == 1);
}

TEST_CASE("digits that the first vertices have are seen before any scan, which is the only one") {
  const TempFolder folder;
  write_file(folder / "m.ply", replaced(ascii_square(), "1 1 0.5", "1 1 5412345.678"));
  const auto source = open_mesh(folder / "m.ply");
  CHECK(source->info().positions == PositionType::float64);
  source->scan_vertices([](std::span<const Vec3> batch) { CHECK(batch[3].z == 5412345.678); });
}

TEST_CASE("a byte order mark is passed over") {
  check_square(read_bytes("\xef\xbb\xbf" + ascii_square()));
  check_square(read_bytes("\xef\xbb\xbf" + binary_square().text()));
}

TEST_CASE("records that are wrapped over lines are read, as long as they end with a line") {
  std::string text = replaced(ascii_square(), "1 0 0\n", "1\n0\n\n0\n");
  check_square(read_bytes(text));
  check_square(read_bytes(replaced(text, "3 2 1 3\n", "3\n2 1\n3")));
  // The same for elements that are skipped.
  text = replaced(text, "element vertex",
                  "element tag 2\nproperty int a\nproperty int b\nelement vertex");
  check_square(read_bytes(replaced(text, "end_header\n", "end_header\n1\n2\n3 4\n")));
  // A missing value is not taken from the next line.
  CHECK(refusal(replaced(ascii_square(), "1 0 0\n", "1 0\n")) ==
        "m.ply: vertex 1 on line 11: the line ends before its last value");
  CHECK(refusal(ascii_square("3 0 1\n3 2 1 3\n")) ==
        "m.ply: face 0 on line 14: the line ends before its last value");
}

TEST_CASE("blank lines are no records; the last may lack its end") {
  check_square(read_bytes(replaced(ascii_square(), "3 0 1 2\n", "\n3 0 1 2\n \t \n\n")));
  std::string bytes = ascii_square();
  bytes.pop_back();
  check_square(read_bytes(bytes));
  std::string smallest = one_vertex("float", "1 2 3");
  smallest.pop_back();
  CHECK(read_bytes(smallest).mesh.positions == std::vector<Vec3>{{1, 2, 3}});
}

TEST_CASE("more values than the header says are left out, and told once") {
  const std::string bytes =
      replaced(replaced(ascii_square("3 0 1 2 9 9\n3 2 1 3 x\n"), "1 0 0\n", "1 0 0 255\n"),
               "0 1 0\n", "0 1 0 255\n");
  const std::string told = stderr_of([&] { check_square(read_bytes(bytes)); });
  CHECK(std::count(told.begin(), told.end(), '\n') == 2);
  CHECK(told.find("m.ply: vertex 1 on line 11: there are more values than the header says") !=
        std::string::npos);
  CHECK(told.find("m.ply: face 0 on line 14: there are more values than the header says") !=
        std::string::npos);
}

TEST_CASE("lines behind the last element are told once, blanks are not") {
  CHECK(stderr_of([] { check_square(read_bytes(ascii_square() + "\n \r\n\t")); }).empty());
  const TempFolder folder;
  write_file(folder / "m.ply", ascii_square() + "3 1 0 2\n");
  const std::string told = stderr_of([&] {
    const auto source = open_mesh(folder / "m.ply");
    CHECK(read_mesh(*source).triangles == k_square_triangles);
    CHECK(read_mesh(*source).triangles == k_square_triangles);
  });
  CHECK(told == "meshfarm: warning: " + (folder / "m.ply").string() +
                    ": there is more in the file than its header says\n");
}

TEST_CASE("extra elements and properties stand anywhere") {
  const std::string bytes =
      "ply\nformat ascii 1.0\n"
      "element camera 2\nproperty float f\nproperty list uchar int tags\n"
      "element nothing 7\n"
      "element face 2\nproperty list uchar float uv\nproperty list ushort uint vertex_indices\n"
      "property uchar flags\n"
      "element edge 1\nproperty int a\nproperty int b\n"
      "element vertex 4\nproperty uchar r\nproperty double z\nproperty list int int ring\n"
      "property float y\nproperty short x\n"
      "element end 1\nproperty list uchar uchar text\n"
      "end_header\n"
      "1.5 2 7 8\n2.5 0\n"
      "2 0.5 0.5 3 0 1 2 255\n0 3 2 1 3 0\n"
      "0 1\n"
      "9 0 0 0 0\n9 0 1 5 0 1\n9 0 2 5 6 1 0\n9 0.5 0 1 1\n"
      "3 65 66 67\n";
  const ReadFile read = read_bytes(bytes);
  check_square(read);
  CHECK(read.info.positions == PositionType::float64);
  CHECK(read.info.skipped == std::vector<std::string>{"camera (2 elements)", "nothing (7 elements)",
                                                      "face.uv", "face.flags", "edge (1 elements)",
                                                      "vertex.ring", "end (1 elements)"});
  CHECK(refusal(bytes.substr(0, bytes.find("3 65"))) ==
        "m.ply: truncated: the file ends on line 32, before end 0 of 1");
}

TEST_CASE("a long file is read through many windows, wherever they end") {
  constexpr int k_count = 230'000;  // slightly more text than a window holds
  Mesh mesh;
  std::string body;
  for (int i = 0; i < k_count; ++i) {
    mesh.positions.push_back({i + 0.25, -i * 1.0, 0.5});
    body += std::to_string(i) + ".25 -" + std::to_string(i) + (i % 7 == 0 ? "   0.5\n" : " 0.5\n");
  }
  REQUIRE(body.size() > (4 << 20) + 1000);
  body += "255";
  for (int i = 0; i < 255; ++i) body += " " + std::to_string(i * 900);
  for (std::size_t shift = 0; shift < 20; ++shift) {
    CAPTURE(shift);
    const ReadFile read =
        read_bytes("ply\nformat ascii 1.0\ncomment " + std::string(shift, '.') + "\n" +
                   mesh_elements(k_count, 1) + "end_header\n" + body + "\n");
    CHECK(read.mesh.positions == mesh.positions);
    CHECK(read.mesh.triangles.size() == 253);
    CHECK(read.mesh.triangles.back() == Triangle{0, 227'700, 228'600});
  }
}

TEST_CASE("any number of threads reads the same, and tells the same line of what is wrong") {
  constexpr int k_count = 60'000;
  std::vector<std::string> lines;
  lines.reserve(std::size_t{2} * k_count);
  for (int i = 0; i < k_count; ++i) lines.push_back(std::to_string(i) + ".25 7 0.5");
  for (int i = 0; i + 3 < k_count; ++i) {
    const std::string three =
        std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2);
    lines.push_back(i % 5 == 0 ? "4 " + three + " " + std::to_string(i + 3) : "3 " + three);
  }
  struct Change {
    std::size_t line;
    std::string text;
    std::string error;
  };
  const std::string at = "/m.ply: ";
  const std::vector<Change> changes = {
      {0, lines[0], ""},
      {41'000, "\n\n  1 2 3 \n\t", ""},    // blank lines
      {41'000, "1\n2\n3", ""},             // wrapped
      {41'000, "1 2 3 4 5", ""},           // more than is declared
      {41'000, "1 nan 3", ""},             // no position
      {41'000, "1.123456789012 2 3", ""},  // more digits than a float holds
      {100'000, "3 0 1\n2", ""},           // wrapped
      {100'000, "2 0 1", ""},              // no face
      {41'000, "1 2", at + "vertex 41000 on line 41010: the line ends before its last value"},
      {41'000, "1 x 3",
       at + "vertex 41000 on line 41010: the coordinate 'x' is no number of type float"},
      {100'000, "3 0 1 60000",
       at + "face 40000 on line 100010: vertex index 60000 is out of range: there are 60000 "
            "vertices"},
  };
  for (const Change& change : changes) {
    CAPTURE(change.text);
    std::string body;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      body += (i == change.line ? change.text : lines[i]) + "\n";
    }
    const std::string bytes =
        "ply\nformat ascii 1.0\n" + mesh_elements(k_count, k_count - 3) + "end_header\n" + body;
    REQUIRE(bytes.size() > (2 << 20));
    const ByThreads one = read_ply_by(1, bytes);
    CHECK(one.error == change.error);
    for (const unsigned threads : {2U, 5U}) {
      const ByThreads many = read_ply_by(threads, bytes);
      CHECK(many.error == one.error);
      CHECK(many.positions == one.positions);
      CHECK(many.mesh.triangles == one.mesh.triangles);
      REQUIRE(many.mesh.positions.size() == one.mesh.positions.size());
      for (std::size_t i = 0; i < one.mesh.positions.size(); ++i) {
        const Vec3 a = one.mesh.positions[i];
        const Vec3 b = many.mesh.positions[i];
        REQUIRE((a == b || (!has_position(a) && !has_position(b))));
      }
    }
  }
}

TEST_CASE("text is parsed once, however often its vertices are scanned and however many") {
  constexpr std::size_t k_count = (std::size_t{2} << 20) + 10'000;  // too many to keep in memory
  std::string bytes = "ply\nformat ascii 1.0\n" + mesh_elements(k_count, 1) + "end_header\n";
  for (std::size_t i = 0; i < k_count; ++i) bytes += std::to_string(i % 1000) + " 0 1\n";
  bytes += "4 0 1 2 3\n";
  const TempFolder folder;
  const auto count = [](MeshSource& source) {
    std::size_t right = 0;
    std::size_t all = 0;
    source.scan_vertices([&](std::span<const Vec3> batch) {
      for (const Vec3& p : batch) right += p == Vec3{static_cast<double>(all++ % 1000), 0, 1};
    });
    return right;
  };
  write_file(folder / "m.ply", bytes);
  const auto source = open_mesh(folder / "m.ply");
  CHECK(count(*source) == k_count);
  std::size_t triangles = 0;
  source->scan_triangles([&](std::span<const WideTriangle> batch) { triangles += batch.size(); });
  CHECK(triangles == 2);
  std::filesystem::resize_file(folder / "m.ply", bytes.size() / 2);
  CHECK(count(*source) == k_count);
  CHECK(std::filesystem::directory_iterator(folder.path())->path().filename() == "m.ply");

  write_file(folder / "m.ply", bytes);
  const auto once = open_mesh(folder / "m.ply", {.scans = Scans::one});
  CHECK(count(*once) == k_count);
  std::filesystem::resize_file(folder / "m.ply", bytes.size() / 2);
  CHECK_THROWS_AS(count(*once), DataError);

  write_file(folder / "m.ply", bytes);
  const Quiet quiet;
  ::setenv("TMPDIR", (folder / "none").c_str(), 1);  // without scratch space it is read again
  const auto without = open_mesh(folder / "m.ply");
  CHECK(count(*without) == k_count);
  CHECK(count(*without) == k_count);
  ::unsetenv("TMPDIR");
}
