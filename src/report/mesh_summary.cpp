// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/report/summary.hpp>

#include "report/summary_words.hpp"

namespace meshfarm {
namespace {

void add_box(Lines& lines, const Box& box) {
  if (box.empty()) return;
  const auto range = [](double lo, double hi) {
    return "[" + number(lo, "%.9g") + ", " + number(hi, "%.9g") + "]";
  };
  lines.add("bounding box", range(box.lo.x, box.hi.x) + " x " + range(box.lo.y, box.hi.y) + " x " +
                                range(box.lo.z, box.hi.z));
  lines.add("diagonal", number(box.diagonal(), "%.9g"));
}

}  // namespace

std::string render(const FileSummary& s, Format format) {
  if (format == Format::json) {
    Json json = {{"path", s.path},
                 {"format", s.file.format},
                 {"compression", s.file.compression},
                 {"vertices", s.file.vertices},
                 {"triangles", s.triangles},
                 {"short_faces", s.short_faces},
                 {"not_finite", s.not_finite},
                 {"dropped_not_finite", s.dropped_not_finite},
                 {"near_misses", s.near_misses > 0 ? Json(s.near_misses) : Json(nullptr)},
                 {"positions", s.file.positions == PositionType::float64 ? "float64" : "float32"},
                 {"channels", names_of(s.file.channels)},
                 {"labels", to_json(s.file.labels)},
                 {"textures", s.file.textures},
                 {"texture_floor", s.texture_floor > 0 ? Json(s.texture_floor) : Json(nullptr)},
                 {"skipped", s.file.skipped},
                 {"box", to_json(s.box)},
                 {"diagonal", s.box.diagonal()}};
    if (s.welded) json["topology"] = to_json(*s.welded);
    if (s.as_it_is) json["topology_not_welded"] = to_json(*s.as_it_is);
    if (s.figures) json["surface"] = to_json(*s.figures);
    if (!s.not_measured.empty()) json["not_measured"] = s.not_measured;
    return dumped(json);
  }
  Lines lines;
  lines.add("file", s.path);
  lines.add("format",
            s.file.format +
                (s.file.compression == "none" ? "" : ", compressed by " + s.file.compression));
  lines.add("triangles", grouped(s.triangles));
  if (s.short_faces > 0) lines.add("left out", grouped(s.short_faces) + " faces of 0 to 2 corners");
  if (s.dropped_not_finite > 0) {
    lines.add("left out",
              counted(s.dropped_not_finite, "triangle") + " with positions that are not finite");
  }
  lines.add("vertices", grouped(s.file.vertices) +
                            (s.file.positions == PositionType::float64 ? ", double" : ", float"));
  if (s.not_finite > 0) {
    lines.add("", grouped(s.not_finite) + " of them with a coordinate that is not finite");
  }
  if (s.near_misses > 0) {
    lines.add("", "corners that belong together are up to " + number(s.near_misses, "%.2g") +
                      " apart: simplify merges them");
  }
  if (!s.file.channels.empty()) lines.add("channels", joined(names_of(s.file.channels)));
  if (s.file.labels) lines.add("labels", text_of(*s.file.labels));
  if (!s.file.textures.empty()) lines.add("textures", joined(s.file.textures));
  if (s.texture_floor > 0) {
    lines.add("", "keeping their charts needs about " + grouped(s.texture_floor) + " triangles");
  }
  if (!s.file.skipped.empty()) lines.add("not kept", joined(s.file.skipped));
  add_box(lines, s.box);
  if (s.welded && s.as_it_is) add_topology(lines, "topology", *s.welded, *s.as_it_is);
  if (s.figures) add_figures(lines, "surface", *s.figures);
  if (!s.not_measured.empty()) {
    lines.add("not measured", "lengths of edges, crossings: " + s.not_measured);
  }
  return lines.text();
}

std::string render(const StreamSummary& s, Format format) {
  if (format == Format::json) {
    const Json json = {
        {"path", s.path},
        {"format", "meshfarm stream"},
        {"vertices", s.stream.vertices},
        {"boundary_vertices", s.stream.boundary_vertices},
        {"triangles", s.stream.triangles},
        {"positions", s.stream.positions == PositionType::float64 ? "float64" : "float32"},
        {"box", to_json(s.box)},
        {"blocks", s.blocks},
        {"widest_front", s.widest_front}};
    return dumped(json);
  }
  Lines lines;
  lines.add("file", s.path);
  lines.add("format", "meshfarm stream, " + grouped(s.blocks) + " blocks");
  lines.add("triangles", grouped(s.stream.triangles));
  lines.add("vertices",
            grouped(s.stream.vertices) +
                (s.stream.positions == PositionType::float64 ? ", double, " : ", float, ") +
                grouped(s.stream.boundary_vertices) + " of them boundary vertices");
  add_box(lines, s.box);
  lines.add("widest front", grouped(s.widest_front) + " vertices");
  return lines.text();
}

std::string render(const HostSummary& host, Format format) {
  if (format == Format::json) {
    const Json json = {
        {"triangles_per_second", host.speed}, {"free_memory", host.memory}, {"cores", host.cores}};
    return dumped(json);
  }
  Lines lines;
  lines.add("speed", grouped(host.speed) + " triangles/s, one thread");
  lines.add("free memory", grouped(host.memory >> 20) + " MiB");
  lines.add("cores", std::to_string(host.cores));
  return lines.text();
}

}  // namespace meshfarm
