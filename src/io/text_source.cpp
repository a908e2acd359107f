// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "text_source.hpp"

#include <utility>

#include <meshfarm/util/control_groups.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {

TextSource::TextSource(InputFile file, const OpenOptions& options, std::string_view format,
                       EndsUnit ends_at)
    : file_(std::move(file)),
      threads_(options.threads == 0 ? processors() : options.threads),
      keep_(options.scans == Scans::many ? VertexStore::Keep::where_possible
                                         : VertexStore::Keep::no) {
  units_.line_end = line_end_of(file_.open()->window(ByteStream::k_max_window_bytes));
  units_.ends_at = ends_at;
  info_.format = format;
  info_.compression = name_of(file_.compression());
}

void TextSource::scan_vertices(const std::function<void(std::span<const Vec3>)>& take) {
  store_.is_filled() ? store_.scan(take) : read_vertices(take, keep_);
}

void TextSource::look_at_digits() {
  TextBlocks text = blocks();
  const std::span<const std::string_view> pieces = text.next();
  if (pieces.empty()) return;
  Points points;
  try {
    parse_vertices(pieces.front(), false, points);
  } catch (const TextError&) {
    return;  // the scan that follows reports the error
  }
  if (points.has_lost_digits) info_.positions = PositionType::float64;
}

void TextSource::read_vertices(const VertexStore::Take& take, VertexStore::Keep keep) {
  const bool wide = info_.positions == PositionType::float64;
  bool has_lost_digits = false;
  std::uint64_t count = 0;
  store_.fill({info_.positions, info_.vertices, keep}, take, [&](const VertexStore::Take& pass) {
    TextBlocks text = blocks();
    for_pieces<Points>(
        text, threads_,
        [&](std::string_view piece, Points& points) {
          points.positions.clear();
          points.has_lost_digits = false;
          parse_vertices(piece, wide, points);
        },
        [&](const Points& points) {
          has_lost_digits = has_lost_digits || points.has_lost_digits;
          count += points.positions.size();
          take_in_batches<Vec3>(points.positions, pass);
        });
    return !has_lost_digits;
  });
  if (count != info_.vertices) fail_changed();
  if (has_lost_digits) info_.positions = PositionType::float64;  // from the next scan on
}

Vec3 TextSource::position_of(std::uint64_t vertex) {
  // At most twice: a second time if digits were lost.
  while (!store_.is_filled()) {
    read_vertices([](std::span<const Vec3>) {}, VertexStore::Keep::always);
  }
  return store_.at(vertex);
}

void TextSource::fail_changed() const {
  throw DataError(file_.path().string() + ": changed while it was read");
}

void TextSource::warn(const std::string& line) {
  if (!line.empty() && warnings_.insert(line).second) log_warning(line);
}

}  // namespace meshfarm
