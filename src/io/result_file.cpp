// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A simplified part, kind "RSLT", little endian. It is written front to back while it is made, so
// counts come after what they count.
//   result  = head | rungs, finest first | 0 u8 | tail | xxh3-64 of everything before
//   head    = "MFRM" | "RSLT" | version u32 | byte order u32 0x01020304 | vertex format u8 |
//             boundary vertices u32 | beside u64 | so many bytes that are no part of the mesh
//   rung    = blocks | 2 u8
//   block   = 1 u8 | vertices u32 | triangles u32 | bytes of packed triangles u32 | vertices |
//             columns | packed triangles (packed_triangles.hpp)
//   tail    = the boundary vertices | sets u32 | sets x samples |
//             rungs u32 | rungs x (level i32 | vertices u64 | triangles u64 | free triangles u64 |
//             error f64)
//   samples = area f64 | points u32 | points, 3 numbers each, of the part's surface
// Vertices are their positions, then their appearances, 4 x u16 each, if the format says so.
// Columns are labels, u32 a triangle, then texture coordinates, 6 x f32 a triangle, if it says so.
// A rung's vertices are the boundary vertices, then those of its blocks. Of a block's vertices
// there are at most 65536, and as many triangles.
//   Version 5. Version 1 was sealed, with the counts in front and one set of samples; version 2 had
//   nothing beside; in version 3 the summary did not say whether a ladder goes on; in version 4
//   triangles were not packed.
// The summary that travels with the message:
//   dropped degenerate u64 | dropped duplicate u64 | held by topology u8 | goes on u8 |
//   turned u64 | rungs u32 | rungs as above | of a part that was built by the same job: vertices
//   u64 | triangles u64 | boundary vertices u32 | coincident vertices u64 | dropped degenerate u64
//   | coincident corners u64 | what is beside (offset u64 | size u64 | checksum u64)
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/io/packed_triangles.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/staged_positions.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_result_magic = {'M', 'F', 'R', 'M'};
constexpr FileKind k_result_kind = {'R', 'S', 'L', 'T'};
constexpr std::uint32_t k_result_version = 5;
constexpr std::uint32_t k_result_byte_order = 0x01020304;
constexpr std::uint32_t k_max_rungs = 256;
constexpr std::uint32_t k_most_in_result_block = 65536;
constexpr std::uint32_t k_max_sets = 1 << 20;
constexpr std::uint8_t k_end_of_rungs = 0;
constexpr std::uint8_t k_block = 1;
constexpr std::uint8_t k_end_of_rung = 2;

void put_rungs(ByteWriter& out, const std::vector<Rung>& rungs) {
  out.put(static_cast<std::uint32_t>(rungs.size()));
  for (const Rung& rung : rungs) {
    out.put(rung.level);
    out.put(rung.vertices);
    out.put(rung.triangles);
    out.put(rung.free_triangles);
    out.put(rung.error);
  }
}

/// From a ByteReader or a ResultReader.
template <class Reader>
std::vector<Rung> get_rungs(Reader& in) {
  const auto count = in.template get<std::uint32_t>();
  if (count == 0 || count > k_max_rungs) in.fail("impossible number of rungs");
  std::vector<Rung> rungs;
  for (std::uint32_t i = 0; i < count; ++i) {
    Rung rung;
    rung.level = in.template get<std::int32_t>();
    rung.vertices = in.template get<std::uint64_t>();
    rung.triangles = in.template get<std::uint64_t>();
    rung.free_triangles = in.template get<std::uint64_t>();
    rung.error = in.template get<double>();
    if (!std::isfinite(rung.error) || rung.error < 0) in.fail("impossible error");
    if (rung.free_triangles > rung.triangles) in.fail("more free triangles than triangles");
    if (i > 0 && (rung.level <= rungs.back().level || rung.triangles > rungs.back().triangles)) {
      in.fail("rungs out of order");
    }
    rungs.push_back(rung);
  }
  return rungs;
}

/// Reads a result front to back. Whatever counts a damaged file names, no more is held than it has.
class ResultReader {
 public:
  ResultReader(const Fill& fill, std::string_view what) : fill_(fill), what_(what) {}

  ResultMesh read(std::size_t wanted) {
    read_head();
    std::vector<Rung> rungs;  // the counts alone
    for (auto tag = get<std::uint8_t>(); tag != k_end_of_rungs; tag = get<std::uint8_t>()) {
      if (tag == k_end_of_rung) {
        rungs.push_back(std::exchange(counts_, {}));
        if (rungs.size() > k_max_rungs) fail("impossible number of rungs");
      } else if (tag == k_block) {
        read_block(rungs.size() == wanted);
      } else {
        fail("neither a block nor the end of a rung");
      }
    }
    read_tail(rungs);
    if (wanted >= rungs.size()) fail("no such rung");
    check_corners();
    return std::move(result_);
  }

  template <class T>
  T get() {
    T value;
    bytes_.resize(sizeof value);
    take();
    std::memcpy(&value, bytes_.data(), sizeof value);
    return value;
  }

  [[noreturn]] void fail(const char* why) const {
    throw DataError(std::string(what_) + ": " + why);
  }

 private:
  void take() {
    fill_(bytes_);
    sum_.add(bytes_);
  }

  void read_head() {
    if (get<FileKind>() != k_result_magic) fail("not a meshfarm file");
    if (get<FileKind>() != k_result_kind) fail("not a result");
    if (get<std::uint32_t>() != k_result_version) fail("a result of an unknown version");
    if (get<std::uint32_t>() != k_result_byte_order) fail("written with another byte order");
    const std::optional<VertexFormat> format = vertex_format_of(get<std::uint8_t>());
    if (!format) fail("unknown kind of positions");
    format_ = *format;
    result_.positions = format_.positions;
    result_.boundary_vertices = get<std::uint32_t>();
    for (auto left = get<std::uint64_t>(); left > 0;) {
      const auto some = std::min<std::uint64_t>(left, k_most_in_result_block);
      bytes_.resize(some);
      take();
      left -= some;
    }
  }

  void read_block(bool is_wanted) {
    const auto vertices = get<std::uint32_t>();
    const auto triangles = get<std::uint32_t>();
    const auto packed = get<std::uint32_t>();
    if (vertices > k_most_in_result_block || triangles > k_most_in_result_block ||
        packed > triangles * k_most_packed) {
      fail("impossible counts");
    }
    counts_.vertices += vertices;
    counts_.triangles += triangles;
    bytes_.resize(vertices * format_.bytes() + triangles * format_.columns.bytes() + packed);
    take();
    if (!is_wanted) return;
    ByteReader in(bytes_, what_);
    get_vertices(in, vertices, format_, inner_.positions, inner_.appearances);
    get_columns(in, triangles, format_.columns, result_.mesh.columns);
    const auto unpacked = unpack_triangles(in.take(packed));
    if (!unpacked || unpacked->size() != triangles) fail("other triangles than promised");
    result_.mesh.triangles.insert(result_.mesh.triangles.end(), unpacked->begin(), unpacked->end());
  }

  std::vector<Vec3> read_points(std::uint32_t count) {
    std::vector<Vec3> points;
    while (points.size() < count) {
      const auto some = std::min<std::size_t>(k_most_in_result_block, count - points.size());
      bytes_.resize(some * 3 * static_cast<std::size_t>(format_.positions));
      take();
      ByteReader in(bytes_, what_);
      const std::vector<Vec3> more = get_positions(in, some, format_.positions);
      points.insert(points.end(), more.begin(), more.end());
    }
    return points;
  }

  void read_boundary_vertices() {
    Mesh& mesh = result_.mesh;
    mesh.positions = read_points(result_.boundary_vertices);
    if (!format_.appearances) return;
    while (mesh.appearances.size() < result_.boundary_vertices) {
      const auto some = std::min<std::size_t>(k_most_in_result_block,
                                              result_.boundary_vertices - mesh.appearances.size());
      bytes_.resize(some * sizeof(Appearance));
      take();
      const auto more = ByteReader(bytes_, what_).get_array<Appearance>(some);
      mesh.appearances.insert(mesh.appearances.end(), more.begin(), more.end());
    }
  }

  void read_tail(const std::vector<Rung>& counted) {
    read_boundary_vertices();
    Mesh& mesh = result_.mesh;
    append_vertices(VertexView(inner_), mesh);
    inner_ = {};
    const auto sets = get<std::uint32_t>();
    if (sets > k_max_sets) fail("impossible number of samples");
    for (std::uint32_t i = 0; i < sets; ++i) {
      SurfaceSamples samples;
      samples.area = get<double>();
      if (!std::isfinite(samples.area) || samples.area < 0) fail("impossible area");
      samples.points = read_points(get<std::uint32_t>());
      result_.samples.push_back(std::move(samples));
    }
    const std::vector<Rung> rungs = get_rungs(*this);
    const auto same = [&](const Rung& told, const Rung& count) {
      return told.triangles == count.triangles &&
             told.vertices == count.vertices + result_.boundary_vertices;
    };
    if (!std::equal(rungs.begin(), rungs.end(), counted.begin(), counted.end(), same)) {
      fail("other counts than its rungs have");
    }
    const std::uint64_t sum = sum_.value();
    if (get<std::uint64_t>() != sum) fail("damaged (checksum)");
  }

  void check_corners() const {
    const std::size_t vertices = result_.mesh.positions.size();
    if (vertices > std::numeric_limits<std::uint32_t>::max()) fail("too many vertices for a part");
    for (const Triangle& t : result_.mesh.triangles) {
      if (t[0] >= vertices || t[1] >= vertices || t[2] >= vertices) {
        fail("a triangle uses a vertex that is not there");
      }
    }
  }

  const Fill& fill_;
  std::string_view what_;
  VertexFormat format_;
  std::string bytes_;
  Checksum sum_;
  Rung counts_;
  Mesh inner_;  // of the wanted rung: all vertices but the boundary vertices
  ResultMesh result_;
};

BuiltFacts get_built(ByteReader& in) {
  BuiltFacts built;
  built.vertices = in.get<std::uint64_t>();
  built.triangles = in.get<std::uint64_t>();
  built.boundary_vertices = in.get<std::uint32_t>();
  if (built.boundary_vertices > built.vertices) in.fail("more boundary vertices than vertices");
  built.coincident_vertices = in.get<std::uint64_t>();
  built.dropped_degenerate = in.get<std::uint64_t>();
  built.coincident_corners = in.get<std::uint64_t>();
  built.beside = in.get<FileSection>();
  return built;
}

}  // namespace

std::string encode_summary(const ResultSummary& summary) {
  ByteWriter out;
  out.put(summary.dropped_degenerate);
  out.put(summary.dropped_duplicate);
  out.put(static_cast<std::uint8_t>(summary.held_by_topology ? 1 : 0));
  out.put(static_cast<std::uint8_t>(summary.goes_on ? 1 : 0));
  out.put(summary.turned);
  put_rungs(out, summary.rungs);
  if (summary.built) {
    const BuiltFacts& built = *summary.built;
    out.put(built.vertices);
    out.put(built.triangles);
    out.put(built.boundary_vertices);
    out.put(built.coincident_vertices);
    out.put(built.dropped_degenerate);
    out.put(built.coincident_corners);
    out.put(built.beside);
  }
  return out.take();
}

ResultSummary decode_summary(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  ResultSummary summary;
  summary.dropped_degenerate = in.get<std::uint64_t>();
  summary.dropped_duplicate = in.get<std::uint64_t>();
  const auto held = in.get<std::uint8_t>();
  const auto goes_on = in.get<std::uint8_t>();
  if (held > 1 || goes_on > 1) in.fail("impossible summary");
  summary.held_by_topology = held == 1;
  summary.goes_on = goes_on == 1;
  summary.turned = in.get<std::uint64_t>();
  summary.rungs = get_rungs(in);
  if (in.remaining() > 0) summary.built = get_built(in);
  in.expect_end();
  return summary;
}

ResultWriter::ResultWriter(const Vertices& vertices, Write write, std::string_view beside)
    : vertices_(vertices), write_(std::move(write)) {
  ByteWriter out;
  out.put(k_result_magic);
  out.put(k_result_kind);
  out.put(k_result_version);
  out.put(k_result_byte_order);
  put_vertex_format(out, {vertices_.positions, vertices_.appearances, vertices_.columns});
  out.put(vertices_.boundary);
  out.put(static_cast<std::uint64_t>(beside.size()));
  beside_ = {out.bytes().size(), beside.size(), checksum(beside)};
  put(out.bytes());
  put(beside);
}

void ResultWriter::put(std::string_view bytes) {
  sum_.add(bytes);
  write_(bytes);
}

void ResultWriter::add(VertexView vertices, std::span<const Triangle> triangles,
                       const TriangleColumnsView& columns) {
  if (!columns.fits(vertices_.columns, triangles.size())) {
    throw Error("triangles without the columns that their file promises");
  }
  rung_.vertices += vertices.size();
  rung_.triangles += triangles.size();
  for (std::size_t done = 0; vertices.size() > 0 || !triangles.empty();) {
    const std::size_t points = std::min<std::size_t>(vertices.size(), k_most_in_result_block);
    const std::size_t corners = std::min<std::size_t>(triangles.size(), k_most_in_result_block);
    const std::string packed = pack_triangles(triangles.first(corners));
    ByteWriter out;
    out.put(k_block);
    out.put(static_cast<std::uint32_t>(points));
    out.put(static_cast<std::uint32_t>(corners));
    out.put(static_cast<std::uint32_t>(packed.size()));
    put_vertices(out, vertices.part(0, points), {vertices_.positions, vertices_.appearances});
    put_columns(out, columns.part(done, corners));
    out.put_array(std::span(std::string_view(packed)));
    done += corners;
    put(out.bytes());
    vertices = vertices.part(points);
    triangles = triangles.subspan(corners);
  }
}

void ResultWriter::end_rung(std::int32_t level, std::uint64_t free_triangles, double error) {
  rungs_.push_back(
      {level, vertices_.boundary + rung_.vertices, rung_.triangles, free_triangles, error});
  rung_ = {};
  put({reinterpret_cast<const char*>(&k_end_of_rung), 1});
}

void ResultWriter::add_rung(std::int32_t level, const Mesh& mesh, std::uint64_t free_triangles,
                            double error) {
  add(VertexView(mesh).part(vertices_.boundary), mesh.triangles, mesh.columns);
  end_rung(level, free_triangles, error);
}

void ResultWriter::finish(const VertexView& boundary, std::span<const SurfaceSamples> samples) {
  ByteWriter out;
  out.put(k_end_of_rungs);
  put_vertices(out, boundary, {vertices_.positions, vertices_.appearances});
  out.put(static_cast<std::uint32_t>(samples.size()));
  for (const SurfaceSamples& set : samples) {
    out.put(set.area);
    out.put(static_cast<std::uint32_t>(set.points.size()));
    put_positions(out, set.points, vertices_.positions);
  }
  put_rungs(out, rungs_);
  put(out.bytes());
  const std::uint64_t sum = sum_.value();
  write_({reinterpret_cast<const char*>(&sum), sizeof sum});
}

ResultMesh read_result(const Fill& fill, std::size_t rung, std::string_view what) {
  return ResultReader(fill, what).read(rung);
}

ResultMesh decode_result(std::string_view file, std::size_t rung, std::string_view what) {
  std::size_t done = 0;
  const Fill from_file = fill_from(file, std::string(what));
  const Fill counted = [&](std::span<char> buffer) {
    from_file(buffer);
    done += buffer.size();
  };
  ResultMesh result = read_result(counted, rung, what);
  if (done != file.size()) throw DataError(std::string(what) + ": bytes behind its end");
  return result;
}

std::string_view beside_of(std::string_view file, std::string_view what) {
  constexpr std::size_t k_size_at =
      2 * sizeof(FileKind) + 2 * sizeof(std::uint32_t) + 1 + sizeof(std::uint32_t);
  ByteReader in(file.substr(std::min(k_size_at, file.size())), what);
  const auto size = in.get<std::uint64_t>();
  const std::size_t begin = k_size_at + sizeof size;
  if (size > file.size() - begin) in.fail("too short for what is beside its mesh");
  return file.substr(begin, size);
}

}  // namespace meshfarm
