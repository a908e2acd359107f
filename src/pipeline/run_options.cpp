// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <meshfarm/pipeline/algorithm.hpp>
#include <meshfarm/pipeline/run_options.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {

std::uint64_t target_triangles(const Manifest& manifest, const RunOptions& options) {
  if (options.triangles != 0) return options.triangles;
  if (options.error.value > 0) return 0;  // as few as the error allows
  if (!(options.ratio > 0 && options.ratio <= 1)) {
    throw UsageError(
        "give the size of the result: --ratio above 0 and up to 1, --triangles, or --error");
  }
  // Of what in the input is a triangle: one number, however the mesh is divided.
  const std::uint64_t left_out =
      std::min(manifest.input_triangles, manifest.dropped_not_finite + manifest.coincident_corners);
  const double wanted = options.ratio * static_cast<double>(manifest.input_triangles - left_out);
  return static_cast<std::uint64_t>(std::llround(wanted));
}

void put(ByteWriter& out, const LineOptions& lines) {
  out.put(static_cast<std::uint8_t>(lines.preserve_border ? 1 : 0));
  out.put(lines.crease_angle);
  out.put(lines.topology);
}

LineOptions get_lines(ByteReader& in) {
  LineOptions lines;
  const auto preserve_border = in.get<std::uint8_t>();
  if (preserve_border > 1) in.fail("impossible options of borders");
  lines.preserve_border = preserve_border == 1;
  lines.crease_angle = in.get<double>();
  if (!(lines.crease_angle >= 0 && lines.crease_angle < 180)) in.fail("impossible crease angle");
  lines.topology = in.get<TopologyMode>();
  if (lines.topology > TopologyMode::keep_while_fair) in.fail("unknown way with the topology");
  return lines;
}

std::uint64_t run_key(const Manifest& manifest, const RunOptions& options) {
  ByteWriter out;
  out.put(k_algorithm_version);
  out.put(checksum(encode_manifest(manifest)));
  out.put(target_triangles(manifest, options));
  // Which may change once slabs are sorted, as degenerate triangles are dropped then.
  if (manifest.sorting) out.put(options.ratio);
  out.put(options.allocation);
  out.put(options.finish);
  out.put(options.composition);
  put(out, options.lines);
  out.put(options.drop_components.in(manifest.box));
  out.put(options.error.in(manifest.box));
  const std::uint64_t key = checksum(out.bytes());
  return key == 0 ? 1 : key;  // 0 means "any run" to the farm
}

}  // namespace meshfarm
