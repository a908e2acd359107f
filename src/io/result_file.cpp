// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A simplified part, kind "RSLT", little endian. It is written front to back while it is made, so
// its directory comes last.
//   result  = head | beside: bytes that are no part of the mesh | rungs, finest first | tail |
//             where the tail is
//   head    = "MFRM" | "RSLT" | version u32 | byte order u32 0x01020304
//   rung    = opened vertices u32 | their numbers, u32 each, ascending | blocks
//   block   = vertices u32 | triangles u32 | bytes of packed triangles u32 | vertices | columns |
//             packed triangles (packed_triangles.hpp)
//   tail    = vertex format u8 | boundary vertices u32 | the boundary vertices |
//             sets u32 | sets x samples | where what is beside is | rungs u32 |
//             rungs x (level i32 | vertices u64 | triangles u64 | free triangles u64 | error f64 |
//             where it is)
//   samples = area f64 | points u32 | points, 3 x f64 each, of the part's surface
//   where   = offset u64 | size u64 | xxh3-64
// Each section has its own checksum, so that a reader of one rung reads only that and the tail.
// Vertices are their positions, then their appearances, 4 x u16 each, if the format says so.
// Columns are labels, u32 a triangle, then texture coordinates, 6 x f32 a triangle, if the format
// says so. A rung's vertices are the boundary vertices, then those of its blocks. A block has at
// most 65536 vertices and as many triangles.
//   Version 9. Version 1 was sealed, with the counts in front and one set of samples; version 2 had
//   nothing beside; in version 3 the summary did not say whether a ladder goes on; in version 4
//   triangles were not packed; version 5 had one checksum for all, at its end; in version 7 samples
//   were rounded as vertices are; version 8 did not name the opened vertices.
// The summary that travels with the message:
//   dropped degenerate u64 | dropped duplicate u64 | held by topology u8 | end of the ladder u8 |
//   turned u64 | rungs as above | where the tail is | where what is beside is | of a part that was
//   built by the same job: vertices u64 | triangles u64 | boundary vertices u32 |
//   shared triangles u64 | shared boundary u32 | coincident vertices u64 | dropped degenerate u64 |
//   coincident corners u64
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/io/packed_triangles.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/staged_positions.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_result_magic = {'M', 'F', 'R', 'M'};
constexpr FileKind k_result_kind = {'R', 'S', 'L', 'T'};
constexpr std::uint32_t k_result_version = 9;
constexpr std::uint32_t k_result_byte_order = 0x01020304;
constexpr std::uint32_t k_most_in_result_block = 65536;
constexpr std::uint32_t k_max_sets = 1 << 20;
constexpr std::size_t k_result_head_bytes = 2 * sizeof(FileKind) + 2 * sizeof(std::uint32_t);

void put_rungs(ByteWriter& out, const std::vector<Rung>& rungs) {
  out.put(static_cast<std::uint32_t>(rungs.size()));
  for (const Rung& rung : rungs) {
    out.put(rung.level);
    out.put(rung.vertices);
    out.put(rung.triangles);
    out.put(rung.free_triangles);
    out.put(rung.error);
    out.put(rung.section);
    out.put(rung.refused);
  }
}

std::vector<Rung> get_rungs(ByteReader& in) {
  const auto count = in.get<std::uint32_t>();
  if (count == 0 || count > k_most_rungs) in.fail("impossible number of rungs");
  std::vector<Rung> rungs;
  for (std::uint32_t i = 0; i < count; ++i) {
    Rung rung;
    rung.level = in.get<std::int32_t>();
    rung.vertices = in.get<std::uint64_t>();
    rung.triangles = in.get<std::uint64_t>();
    rung.free_triangles = in.get<std::uint64_t>();
    rung.error = in.get<double>();
    rung.section = in.get<FileSection>();
    rung.refused = in.get<std::uint64_t>();
    if (!std::isfinite(rung.error) || rung.error < 0) in.fail("impossible error");
    if (rung.free_triangles > rung.triangles) in.fail("more free triangles than triangles");
    if (i > 0 && (rung.level <= rungs.back().level || rung.triangles > rungs.back().triangles)) {
      in.fail("rungs out of order");
    }
    rungs.push_back(rung);
  }
  return rungs;
}

std::string result_head() {
  ByteWriter out;
  out.put(k_result_magic);
  out.put(k_result_kind);
  out.put(k_result_version);
  out.put(k_result_byte_order);
  return out.take();
}

void check_result_head(ByteReader in) {
  if (in.get<FileKind>() != k_result_magic) in.fail("not a meshfarm file");
  if (in.get<FileKind>() != k_result_kind) in.fail("not a result");
  if (in.get<std::uint32_t>() != k_result_version) in.fail("a result of an unknown version");
  if (in.get<std::uint32_t>() != k_result_byte_order) in.fail("written with another byte order");
}

/// Where little was lost, the error is smaller than the rounding of floats.
constexpr PositionType k_sample_type = PositionType::float64;

std::vector<Vec3> get_sample_points(ByteReader& in) {
  const auto count = in.get<std::uint32_t>();
  if (count > in.remaining() / (3 * static_cast<std::size_t>(k_sample_type))) in.fail("too short");
  return get_positions(in, count, k_sample_type);
}

/// The part that all rungs have in common, and where the rungs are.
struct ResultTail {
  ResultMesh common;  // the mesh has the boundary vertices only
  VertexFormat format;
  FileSection beside;
  std::vector<Rung> rungs;
};

ResultTail get_result_tail(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  ResultTail tail;
  tail.format = get_vertex_format(in);
  tail.common.positions = tail.format.positions;
  const auto boundary = in.get<std::uint32_t>();
  tail.common.boundary_vertices = boundary;
  if (boundary > in.remaining() / tail.format.bytes()) {
    in.fail("too short for its boundary vertices");
  }
  Mesh& mesh = tail.common.mesh;
  get_vertices(in, boundary, tail.format, mesh.positions, mesh.appearances);
  const auto sets = in.get<std::uint32_t>();
  if (sets > k_max_sets) in.fail("impossible number of samples");
  for (std::uint32_t i = 0; i < sets; ++i) {
    SurfaceSamples samples;
    samples.area = in.get<double>();
    if (!std::isfinite(samples.area) || samples.area < 0) in.fail("impossible area");
    samples.points = get_sample_points(in);
    tail.common.samples.push_back(std::move(samples));
  }
  tail.beside = in.get<FileSection>();
  tail.rungs = get_rungs(in);
  in.expect_end();
  return tail;
}

/// Adds the rung to the common part.
void get_rung(std::string_view bytes, const VertexFormat& format, std::string_view what,
              ResultMesh& result) {
  ByteReader in(bytes, what);
  Mesh& mesh = result.mesh;
  result.opened = in.get_array<std::uint32_t>(in.get<std::uint32_t>());
  while (in.remaining() > 0) {
    const auto vertices = in.get<std::uint32_t>();
    const auto triangles = in.get<std::uint32_t>();
    const auto packed = in.get<std::uint32_t>();
    if (vertices > k_most_in_result_block || triangles > k_most_in_result_block ||
        packed > triangles * k_most_packed) {
      in.fail("impossible counts");
    }
    get_vertices(in, vertices, format, mesh.positions, mesh.appearances);
    get_columns(in, triangles, format.columns, mesh.columns);
    const auto unpacked = unpack_triangles(in.take(packed));
    if (!unpacked || unpacked->size() != triangles) in.fail("other triangles than promised");
    mesh.triangles.insert(mesh.triangles.end(), unpacked->begin(), unpacked->end());
  }
  const std::size_t all = mesh.positions.size();
  if (all > std::numeric_limits<std::uint32_t>::max()) in.fail("too many vertices for a part");
  for (const Triangle& t : mesh.triangles) {
    if (t[0] >= all || t[1] >= all || t[2] >= all) {
      in.fail("a triangle uses a vertex that is not there");
    }
  }
  const std::vector<std::uint32_t>& opened = result.opened;
  const bool ascends =
      std::adjacent_find(opened.begin(), opened.end(), std::greater_equal()) == opened.end();
  if (!ascends || (!opened.empty() && opened.back() >= all)) in.fail("impossible opened vertices");
}

ResultMesh with_rung(ResultTail tail, std::size_t rung, std::string_view bytes,
                     std::string_view what) {
  if (rung >= tail.rungs.size()) throw DataError(std::string(what) + ": no such rung");
  get_rung(bytes, tail.format, what, tail.common);
  const Rung& told = tail.rungs[rung];
  const Mesh& mesh = tail.common.mesh;
  if (told.triangles != mesh.triangles.size() || told.vertices != mesh.positions.size()) {
    throw DataError(std::string(what) + ": other counts than its rung has");
  }
  return std::move(tail.common);
}

/// The sections of a whole file, which must follow each other from its head to its end.
class WholeResult {
 public:
  WholeResult(std::string_view file, std::string_view what) : file_(file), what_(what) {
    check_result_head(ByteReader(file.substr(0, k_result_head_bytes), what));
    if (file.size() < k_result_head_bytes + sizeof(FileSection)) fail("too short");
    const std::size_t end = file.size() - sizeof(FileSection);
    const auto tail = ByteReader(file.substr(end), what).get<FileSection>();
    tail_ = get_result_tail(bytes_of(tail), what);
    std::uint64_t next = k_result_head_bytes;
    const auto expect = [&](const FileSection& section) {
      if (section.offset != next) fail("damaged (sections)");
      bytes_of(section);
      next += section.size;
    };
    expect(tail_.beside);
    for (const Rung& rung : tail_.rungs) expect(rung.section);
    if (tail.offset != next || tail.size != end - next) fail("damaged (sections)");
  }

  ResultMesh take(std::size_t rung) {
    if (rung >= tail_.rungs.size()) fail("no such rung");
    const FileSection& section = tail_.rungs[rung].section;
    const std::string_view bytes = file_.substr(section.offset, section.size);
    return with_rung(std::move(tail_), rung, bytes, what_);
  }

 private:
  [[noreturn]] void fail(const char* why) const {
    throw DataError(std::string(what_) + ": " + why);
  }
  std::string_view bytes_of(const FileSection& section) const {
    if (section.offset > file_.size() || section.size > file_.size() - section.offset) {
      fail("cut short");
    }
    const std::string_view bytes = file_.substr(section.offset, section.size);
    if (checksum(bytes) != section.hash) fail("damaged (checksum)");
    return bytes;
  }

  std::string_view file_;
  std::string_view what_;
  ResultTail tail_;
};

BuiltFacts get_built(ByteReader& in) {
  BuiltFacts built;
  built.vertices = in.get<std::uint64_t>();
  built.triangles = in.get<std::uint64_t>();
  built.boundary_vertices = in.get<std::uint32_t>();
  if (built.boundary_vertices > built.vertices) in.fail("more boundary vertices than vertices");
  built.shared_triangles = in.get<std::uint64_t>();
  built.shared_boundary = in.get<std::uint32_t>();
  built.coincident_vertices = in.get<std::uint64_t>();
  built.dropped_degenerate = in.get<std::uint64_t>();
  built.coincident_corners = in.get<std::uint64_t>();
  return built;
}

}  // namespace

std::string encode_summary(const ResultSummary& summary) {
  ByteWriter out;
  out.put(summary.dropped_degenerate);
  out.put(summary.dropped_duplicate);
  out.put(static_cast<std::uint8_t>(summary.held_by_topology ? 1 : 0));
  out.put(summary.end);
  out.put(summary.turned);
  put_rungs(out, summary.rungs);
  out.put(summary.tail);
  out.put(summary.beside);
  if (summary.built) {
    const BuiltFacts& built = *summary.built;
    out.put(built.vertices);
    out.put(built.triangles);
    out.put(built.boundary_vertices);
    out.put(built.shared_triangles);
    out.put(built.shared_boundary);
    out.put(built.coincident_vertices);
    out.put(built.dropped_degenerate);
    out.put(built.coincident_corners);
  }
  return out.take();
}

ResultSummary decode_summary(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  ResultSummary summary;
  summary.dropped_degenerate = in.get<std::uint64_t>();
  summary.dropped_duplicate = in.get<std::uint64_t>();
  const auto held = in.get<std::uint8_t>();
  summary.end = in.get<LadderEnd>();
  if (held > 1 || summary.end > LadderEnd::refusals) in.fail("impossible summary");
  summary.held_by_topology = held == 1;
  summary.turned = in.get<std::uint64_t>();
  summary.rungs = get_rungs(in);
  summary.tail = in.get<FileSection>();
  summary.beside = in.get<FileSection>();
  if (in.remaining() > 0) summary.built = get_built(in);
  in.expect_end();
  return summary;
}

ResultWriter::ResultWriter(const Vertices& vertices, Write write, std::string_view beside)
    : vertices_(vertices), write_(std::move(write)) {
  put(result_head());
  end_section();
  put(beside);
  beside_ = end_section();
}

void ResultWriter::put(std::string_view bytes) {
  sum_.add(bytes);
  section_.size += bytes.size();
  write_(bytes);
}

/// The section of all bytes put since the previous one ended.
FileSection ResultWriter::end_section() {
  section_.hash = std::exchange(sum_, {}).value();
  const std::uint64_t end = section_.offset + section_.size;
  return std::exchange(section_, {.offset = end});
}

void ResultWriter::begin_rung(std::span<const std::uint32_t> opened) {
  ByteWriter out;
  out.put(static_cast<std::uint32_t>(opened.size()));
  out.put_array(opened);
  put(out.bytes());
}

void ResultWriter::add(VertexView vertices, std::span<const Triangle> triangles,
                       const TriangleColumnsView& columns) {
  if (!columns.fits(vertices_.columns, triangles.size())) {
    throw Error("triangles without the columns that their file promises");
  }
  if (section_.size == 0) begin_rung({});
  rung_.vertices += vertices.size();
  rung_.triangles += triangles.size();
  for (std::size_t done = 0; vertices.size() > 0 || !triangles.empty();) {
    const std::size_t points = std::min<std::size_t>(vertices.size(), k_most_in_result_block);
    const std::size_t corners = std::min<std::size_t>(triangles.size(), k_most_in_result_block);
    const std::string packed = pack_triangles(triangles.first(corners));
    ByteWriter out;
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

void ResultWriter::end_rung(std::int32_t level, std::uint64_t free_triangles, double error,
                            std::uint64_t refused) {
  if (section_.size == 0) begin_rung({});
  rungs_.push_back({level, vertices_.boundary + rung_.vertices, rung_.triangles, free_triangles,
                    error, end_section(), refused});
  rung_ = {};
}

void ResultWriter::add_rung(std::int32_t level, const Mesh& mesh, std::uint64_t free_triangles,
                            double error, std::uint64_t refused,
                            std::span<const std::uint32_t> opened) {
  begin_rung(opened);
  add(VertexView(mesh).part(vertices_.boundary), mesh.triangles, mesh.columns);
  end_rung(level, free_triangles, error, refused);
}

void ResultWriter::finish(const VertexView& boundary, std::span<const SurfaceSamples> samples) {
  ByteWriter out;
  put_vertex_format(out, {vertices_.positions, vertices_.appearances, vertices_.columns});
  out.put(vertices_.boundary);
  put_vertices(out, boundary, {vertices_.positions, vertices_.appearances});
  out.put(static_cast<std::uint32_t>(samples.size()));
  for (const SurfaceSamples& set : samples) {
    out.put(set.area);
    out.put(static_cast<std::uint32_t>(set.points.size()));
    put_positions(out, set.points, k_sample_type);
  }
  out.put(beside_);
  put_rungs(out, rungs_);
  put(out.bytes());
  tail_ = end_section();
  ByteWriter end;
  end.put(tail_);
  write_(end.bytes());
}

ResultMesh decode_rung(std::string_view rung_bytes, std::string_view tail, std::size_t rung,
                       std::string_view what) {
  return with_rung(get_result_tail(tail, what), rung, rung_bytes, what);
}

ResultMesh decode_result(std::string_view file, std::size_t rung, std::string_view what) {
  return WholeResult(file, what).take(rung);
}

}  // namespace meshfarm
