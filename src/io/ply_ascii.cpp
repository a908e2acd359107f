// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <utility>

#include <meshfarm/util/errors.hpp>

#include "ply_ascii_cursor.hpp"
#include "ply_body.hpp"

namespace meshfarm {
namespace {

/// Records of an ascii PLY file: each begins on a line of its own. Some writers wrap long ones;
/// such a record must end where a line does, so that a missing value is still noticed. Blank lines
/// do not count.
class AsciiBody final : public PlyBody {
 public:
  AsciiBody(std::unique_ptr<ByteStream> stream, const std::filesystem::path& path,
            const PlyHeader& header, AsciiFloats floats)
      : cursor_(std::move(stream), header.line_end, header.lines + 1), path_(path) {
    if (floats == AsciiFloats::as_doubles) cursor_.read_floats_wide();
  }

  void read_vertices(const PlyElement& element, Batch<Vec3>& batch) override {
    begin(element);
    std::vector<std::size_t> axis_of(element.properties.size(), 3);
    for (std::size_t axis = 0; axis < 3; ++axis) axis_of[element.axes[axis]] = axis;
    for (; index_ < element.count; ++index_) {
      next_record();
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
    }
    batch.flush();
  }

  void read_corners(const PlyElement& element, TriangleMaker& maker) override {
    begin(element);
    for (; index_ < element.count; ++index_) {
      next_record();
      maker.begin(element.role);
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        i == element.index_list ? read_corner_list(property, maker) : skip(property);
      }
      end_record();
      maker.end();
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
  bool has_lost_digits() const override { return cursor_.has_lost_digits(); }
  std::string take_oddity() override { return std::exchange(oddity_, {}); }

 private:
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

  void next_record() {
    if (cursor_.next_record()) {
      line_ = cursor_.line();
      return;
    }
    throw DataError(path_.string() + ": truncated: the file ends on line " +
                    std::to_string(cursor_.line()) + ", before " + element_->name + " " +
                    std::to_string(index_) + " of " + std::to_string(element_->count));
  }

  /// Some writers put more on a line than they declare. What comes first is what is declared.
  void end_record() {
    const bool is_wrapped = cursor_.line() != line_;
    if (cursor_.end_record()) return;
    if (is_wrapped) fail_short();
    if (oddity_.empty()) {
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

  void read_corner_list(const PlyProperty& property, TriangleMaker& maker) {
    for (std::uint64_t left = read_list_length(property); left > 0; --left) {
      need_value();
      const std::optional<std::int64_t> index = cursor_.whole(property.type);
      if (!index) fail("the vertex index " + cursor_.token() + " is not a whole number");
      if (!maker.corner(*index)) {
        fail("vertex index " + std::to_string(*index) + " is out of range: there are " +
             std::to_string(maker.vertices()) + " vertices");
      }
    }
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

  AsciiCursor cursor_;
  const std::filesystem::path& path_;
  const PlyElement* element_ = nullptr;
  std::uint64_t index_ = 0;
  std::uint64_t line_ = 0;  // on which the record begins
  std::string oddity_;
};

}  // namespace

std::unique_ptr<PlyBody> make_ascii_body(std::unique_ptr<ByteStream> stream,
                                         const std::filesystem::path& path, const PlyHeader& header,
                                         AsciiFloats floats) {
  return std::make_unique<AsciiBody>(std::move(stream), path, header, floats);
}

}  // namespace meshfarm
