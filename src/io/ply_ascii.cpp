// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <meshfarm/util/control_groups.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

#include "ply_ascii_cursor.hpp"
#include "ply_body.hpp"
#include "text_pieces.hpp"

namespace meshfarm {
namespace {

/// Records of an ascii PLY file: each begins on a line of its own. Some writers wrap long ones;
/// such a record must end at the end of a line, so that a missing value is still noticed. Blank
/// lines do not count.
///
/// Whole lines are divided into pieces, which threads parse, each as a body of its own. Their
/// records are taken in order as long as no earlier piece had anything odd about it; from there to
/// the last of those lines, records are read one by one. So there is one way to read a record, and
/// messages name its line.
class AsciiBody final : public PlyBody {
 public:
  AsciiBody(std::unique_ptr<ByteStream> stream, const std::filesystem::path& path, char line_end,
            std::uint64_t line, const AsciiOptions& options)
      : cursor_(std::move(stream), line_end, line),
        path_(path),
        line_end_(line_end),
        options_(options) {
    if (options.floats == AsciiFloats::as_doubles) cursor_.read_floats_wide();
    if (options.has_comments) cursor_.pass_comments();
    if (options_.threads == 0) options_.threads = processors();
  }

  void read_vertices(const PlyElement& element, Batch<Vec3>& batch) override {
    const auto parse = [&](AsciiBody& body, Piece& piece) {
      const Batch<Vec3>::Take keep = [&](std::span<const Vec3> some) {
        piece.points.insert(piece.points.end(), some.begin(), some.end());
      };
      Batch<Vec3> points(keep);
      body.read_vertices_to_end(element, points);
    };
    const auto take = [&](const Piece& piece) {
      for (const Vec3& p : piece.points) batch.add(p);
    };
    const std::vector<std::size_t> axis_of = axes_of(element);
    begin(element);
    while (index_ < element.count) {
      if (read_pieces(parse, take)) continue;
      next_record();
      read_vertex(element, axis_of, batch);
    }
    batch.flush();
  }

  void read_channels(const PlyElement& element, std::span<const PlyChannel> channels,
                     ChannelBatch& batch) override {
    begin(element);
    ChannelRow row(element, channels);
    for (; index_ < element.count; ++index_) {
      next_record();
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        // A colour of type byte may still have a decimal point.
        const PlyType type = row.is_axis(i) ? property.type : PlyType::float64;
        row.wants(i) ? row.set(i, read_coordinate(type)) : skip(property);
      }
      end_record();
      row.add_to(batch);
    }
    batch.flush();
  }

  void read_corners(const PlyElement& element, TriangleMaker& maker) override {
    const auto parse = [&](AsciiBody& body, Piece& piece) {
      piece.corners.emplace(maker.vertices());
      body.read_corners_to_end(element, *piece.corners);
    };
    const auto take = [&](const Piece& piece) { piece.corners->play(maker); };
    begin(element);
    while (index_ < element.count) {
      if (read_pieces(parse, take)) continue;
      next_record();
      read_face(element, maker);
    }
    maker.batch().flush();
  }

  void skip(const PlyElement& element) override {
    begin(element);
    if (element.properties.empty()) return;
    for (; index_ < element.count; ++index_) {
      next_record();
      for (const PlyProperty& property : element.properties) skip(property);
      end_record();
    }
  }

  bool at_end() override { return !cursor_.next_record(); }
  bool has_lost_digits() const override { return has_lost_digits_ || cursor_.has_lost_digits(); }
  std::string take_oddity() override {
    if (oddity_.empty() && has_more_) {
      has_more_ = false;
      return path_.string() + ": there are values after the " +
             (element_->role == PlyRole::vertices ? "positions" : "corners of faces") +
             ", colours maybe; they are not read";
    }
    return std::exchange(oddity_, {});
  }

 private:
  /// The result of a thread.
  struct Piece {
    std::string_view text;
    bool is_clean = false;
    std::uint64_t records = 0;
    std::uint64_t lines = 0;
    bool has_lost_digits = false;
    bool has_more = false;
    std::vector<Vec3> points;
    std::optional<CornerRecord> corners;
  };

  static std::vector<std::size_t> axes_of(const PlyElement& element) {
    std::vector<std::size_t> axis_of(element.properties.size(), 3);
    for (std::size_t axis = 0; axis < 3; ++axis) axis_of[element.axes[axis]] = axis;
    return axis_of;
  }

  /// For the body of a piece: reads all records.
  void read_vertices_to_end(const PlyElement& element, Batch<Vec3>& batch) {
    const std::vector<std::size_t> axis_of = axes_of(element);
    begin(element);
    while (is_at_record()) read_vertex(element, axis_of, batch);
    batch.flush();
  }
  void read_corners_to_end(const PlyElement& element, CornerRecord& corners) {
    begin(element);
    while (is_at_record()) read_face(element, corners);
  }

  void read_vertex(const PlyElement& element, const std::vector<std::size_t>& axis_of,
                   Batch<Vec3>& batch) {
    std::array<double, 3> xyz{};
    for (std::size_t i = 0; i < axis_of.size(); ++i) {
      if (axis_of[i] == 3) {
        skip(element.properties[i]);
      } else {
        xyz[axis_of[i]] = read_coordinate(element.properties[i].type);
      }
    }
    end_record();
    const Vec3 p{xyz[0], xyz[1], xyz[2]};
    batch.add(is_finite(p) ? p : k_no_position);
    ++index_;
  }

  template <class Maker>
  void read_face(const PlyElement& element, Maker& maker) {
    maker.begin(corner_order(element));
    uvs_.clear();
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (i == element.index_list) {
        read_corner_list(property, maker);
      } else if (i == element.label) {
        maker.label(read_label(property));
      } else if (i == element.uvs) {
        read_uv_list(property);
      } else {
        skip(property);
      }
    }
    end_record();
    if (element.uvs) maker.uvs(uvs_);
    maker.end();
    ++index_;
  }

  /// Takes the next records from pieces. False if the next one must be read by itself.
  template <class Parse, class Take>
  bool read_pieces(const Parse& parse, const Take& take) {
    if (options_.threads < 2 || cursor_.position() < one_by_one_to_) return false;
    const std::string_view text = cursor_.lines_ahead();
    const std::uint64_t start = cursor_.position();
    one_by_one_to_ = start + std::max<std::size_t>(1, text.size());
    if (text.size() < k_worth_dividing) return false;
    std::vector<Piece> pieces;
    for (const std::string_view lines : pieces_of(text, options_.threads, line_end_)) {
      pieces.push_back({.text = lines});
    }
    parallel_for(pieces.size(), options_.threads,
                 [&](std::uint64_t i) { read_piece(pieces[i], parse); });
    for (const Piece& piece : pieces) {
      if (!piece.is_clean || piece.records > element_->count - index_) {
        if (++odd_texts_ == k_most_odd_texts) options_.threads = 1;
        return cursor_.position() != start;
      }
      take(piece);
      index_ += piece.records;
      cursor_.pass(piece.text.size(), piece.lines);
      has_lost_digits_ = has_lost_digits_ || piece.has_lost_digits;
      has_more_ = has_more_ || piece.has_more;
    }
    return true;
  }

  template <class Parse>
  void read_piece(Piece& piece, const Parse& parse) const {
    AsciiBody body(std::make_unique<TextStream>(piece.text), path_, line_end_, 0,
                   {options_.floats, 1, options_.has_comments});
    try {
      parse(body, piece);
    } catch (const DataError&) {
      return;  // it is read again, and the message then has its place in the file
    }
    piece.is_clean = body.oddity_.empty();
    piece.records = body.index_;
    piece.lines = body.cursor_.line();
    piece.has_lost_digits = body.has_lost_digits();
    piece.has_more = body.has_more_;
  }

  void begin(const PlyElement& element) {
    element_ = &element;
    index_ = 0;
  }

  std::string place() const { return place_on(cursor_.line()); }
  std::string place_on(std::uint64_t line) const {
    return path_.string() + ": " + element_->name + " " + std::to_string(index_) + " on line " +
           std::to_string(line);
  }
  [[noreturn]] void fail(const std::string& why) const { throw DataError(place() + ": " + why); }

  bool is_at_record() {
    if (!cursor_.next_record()) return false;
    line_ = cursor_.line();
    return true;
  }

  void next_record() {
    if (is_at_record()) return;
    throw DataError(path_.string() + ": truncated: the file ends on line " +
                    std::to_string(cursor_.line()) + ", before " + element_->name + " " +
                    std::to_string(index_) + " of " + std::to_string(element_->count));
  }

  /// Some writers put more on a line than they declare. The declared values come first.
  void end_record() {
    const bool is_wrapped = cursor_.line() != line_;
    if (cursor_.end_record()) return;
    if (is_wrapped) fail_short();
    has_more_ = has_more_ || element_->more == MoreValues::told;
    if (oddity_.empty() && element_->more == MoreValues::odd) {
      oddity_ = place() +
                ": there are more values than the header says; they are not read, here "
                "and further on";
    }
    cursor_.skip_record();
  }

  void need_value() {
    if (!cursor_.has_value() && !cursor_.next_record()) fail_short();
  }
  [[noreturn]] void fail_short() const {
    throw DataError(place_on(line_) + ": the line ends before its last value");
  }

  double read_coordinate(PlyType type) {
    need_value();
    const std::optional<double> value = cursor_.real(type);
    if (!value) {
      fail("the coordinate " + cursor_.token() + " is no number of type " +
           std::string(name_of(type)));
    }
    return *value;
  }

  template <class Maker>
  void read_corner_list(const PlyProperty& property, Maker& maker) {
    std::uint64_t left = read_list_length(property);
    if (element_->has_late_label() && left > TriangleMaker::k_most_held_corners) {
      fail(TriangleMaker::k_too_long_for_label);
    }
    for (; left > 0; --left) {
      need_value();
      const std::optional<std::int64_t> index = cursor_.whole(property.type);
      if (!index) fail("the vertex index " + cursor_.token() + " is not a whole number");
      if (!maker.corner(*index)) {
        fail("vertex index " + std::to_string(*index) + " is out of range: there are " +
             std::to_string(maker.vertices()) + " vertices");
      }
    }
  }

  /// Those of a face with too many corners to be kept are not kept.
  void read_uv_list(const PlyProperty& property) {
    const std::uint64_t count = read_list_length(property);
    const bool are_kept = count % 2 == 0 && count / 2 <= TriangleMaker::k_most_held_corners;
    for (std::uint64_t i = 0; i < count; ++i) {
      need_value();
      const std::optional<double> read = cursor_.real(PlyType::float64);
      if (!read) fail("the texture coordinate " + cursor_.token() + " is no number");
      const auto value = static_cast<float>(*read);
      if (!are_kept) continue;
      if (i % 2 == 0) uvs_.emplace_back();
      uvs_.back()[i % 2] = std::isfinite(value) ? value : 0;
    }
  }

  /// Negative values wrap around.
  Label read_label(const PlyProperty& property) {
    need_value();
    const std::optional<std::int64_t> value = cursor_.whole(property.type);
    if (!value) fail(property.name + " is " + cursor_.token() + ", which is not a whole number");
    if (*value < INT32_MIN || *value > std::int64_t{UINT32_MAX}) {
      fail(property.name + " is " + std::to_string(*value) + ", which has more than 32 bits");
    }
    return static_cast<Label>(*value);
  }

  std::uint64_t read_list_length(const PlyProperty& property) {
    need_value();
    const std::optional<std::int64_t> length = cursor_.whole(*property.count_type);
    if (!length) {
      fail("list " + property.name + " has the count " + cursor_.token() +
           ", which is not a whole number");
    }
    if (*length < 0) fail("list " + property.name + " has a count below zero");
    return static_cast<std::uint64_t>(*length);
  }

  void skip(const PlyProperty& property) {
    std::uint64_t values = property.is_list() ? read_list_length(property) : 1;
    for (; values > 0; --values) {
      need_value();
      cursor_.skip_value();
    }
  }

  static constexpr std::size_t k_worth_dividing = std::size_t{64} << 10;
  static constexpr unsigned k_most_odd_texts = 8;  // all records may be wrapped

  AsciiCursor cursor_;
  const std::filesystem::path& path_;
  char line_end_;
  AsciiOptions options_;
  const PlyElement* element_ = nullptr;
  std::uint64_t index_ = 0;
  std::uint64_t line_ = 0;  // on which the record begins
  std::string oddity_;
  std::uint64_t one_by_one_to_ = 0;  // position in the stream
  unsigned odd_texts_ = 0;
  bool has_lost_digits_ = false;  // in pieces
  bool has_more_ = false;         // more values than are read, to be reported
  std::vector<Uv> uvs_;           // of the face at hand
};

}  // namespace

std::unique_ptr<PlyBody> make_ascii_body(std::unique_ptr<ByteStream> stream,
                                         const std::filesystem::path& path, const PlyHeader& header,
                                         const AsciiOptions& options) {
  return std::make_unique<AsciiBody>(std::move(stream), path, header.line_end, header.lines + 1,
                                     options);
}

}  // namespace meshfarm
