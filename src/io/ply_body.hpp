// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/io/mesh_source.hpp>

#include "byte_stream.hpp"
#include "ply_header.hpp"
#include "polygon.hpp"

namespace meshfarm {

/// Collects items and hands them on in batches.
template <class T>
class Batch {
 public:
  using Take = std::function<void(std::span<const T>)>;

  explicit Batch(const Take& take) : take_(take), items_(k_most_items) {}

  void add(const T& item) {
    items_[size_] = item;
    added(1);
  }
  /// Room for items that the caller writes and then counts with added().
  std::span<T> room() { return std::span(items_).subspan(size_); }
  void added(std::size_t count) {
    size_ += count;
    if (size_ == k_most_items) flush();
  }
  void flush() {
    if (size_ > 0) take_(std::span(items_).first(size_));
    size_ = 0;
  }

 private:
  static constexpr std::size_t k_most_items = 8192;  // stays in the second-level cache
  const Take& take_;
  std::vector<T> items_;
  std::size_t size_ = 0;
};

/// Makes triangles of the corners of faces and strips. Of a face with more than three corners the
/// positions are asked for; it is kept up to k_most_corners, and a longer one is taken for a fan.
class TriangleMaker {
 public:
  using PositionOf = std::function<Vec3(std::uint64_t vertex)>;
  static constexpr std::size_t k_most_corners = 1 << 16;

  TriangleMaker(std::uint64_t vertices, const Batch<WideTriangle>::Take& take,
                PositionOf position_of)
      : vertices_(vertices), batch_(take), position_of_(std::move(position_of)) {}

  void begin(PlyRole role) {
    role_ = role;
    corners_ = 0;
  }
  /// False if there is no such vertex.
  bool corner(std::int64_t index) {
    const auto vertex = static_cast<std::uint64_t>(index);
    if (vertex >= vertices_) return restart(index);
    role_ == PlyRole::strips ? add_to_strip(vertex) : add_to_face(vertex);
    ++corners_;
    return true;
  }
  void end() {
    if (role_ != PlyRole::faces) return;
    if (corners_ < 3) {
      ++small_faces_;
    } else if (corners_ == 3) {
      batch_.add({face_[0], face_[1], face_[2]});
    } else if (corners_ <= k_most_corners) {
      cut_face();
    } else {
      ++long_faces_;
    }
  }

  std::uint64_t vertices() const { return vertices_; }
  std::uint64_t small_faces() const { return small_faces_; }
  /// Faces that became fans although that may be wrong.
  std::uint64_t guessed_faces() const { return long_faces_ + cutter_.failed(); }
  Batch<WideTriangle>& batch() { return batch_; }

 private:
  bool restart(std::int64_t index) {
    corners_ = 0;
    return role_ == PlyRole::strips && index == -1;
  }
  void add_to_face(std::uint64_t vertex) {
    if (corners_ < face_.size()) {
      face_[corners_] = vertex;
    } else if (corners_ < k_most_corners) {
      face_.resize(2 * face_.size());
      face_[corners_] = vertex;
    } else {
      add_to_fan(vertex);
    }
  }
  /// Of a face that is too long. Its first and its last corner are at the ends of face_.
  void add_to_fan(std::uint64_t vertex) {
    for (std::size_t i = 1; corners_ == k_most_corners && i + 1 < corners_; ++i) {
      batch_.add({face_[0], face_[i], face_[i + 1]});
    }
    batch_.add({face_[0], face_.back(), vertex});
    face_.back() = vertex;
  }
  void cut_face() {
    positions_.clear();
    for (std::size_t i = 0; i < corners_; ++i) positions_.push_back(position_of_(face_[i]));
    for (const auto& [a, b, c] : cutter_.cut(positions_)) {
      batch_.add({face_[a], face_[b], face_[c]});
    }
  }
  void add_to_strip(std::uint64_t vertex) {
    if (corners_ < 2) {
      last_[corners_] = vertex;
      return;
    }
    // Every second triangle of a strip runs the other way round. A repeated vertex is how strips
    // are joined into one, not a face.
    const bool odd = corners_ % 2 != 0;
    if (last_[0] != last_[1] && last_[1] != vertex && last_[0] != vertex) {
      batch_.add({last_[odd ? 1 : 0], last_[odd ? 0 : 1], vertex});
    }
    last_ = {last_[1], vertex};
  }

  std::uint64_t vertices_;
  Batch<WideTriangle> batch_;
  PositionOf position_of_;
  PolygonCutter cutter_;
  PlyRole role_ = PlyRole::faces;
  std::uint64_t corners_ = 0;
  std::array<std::uint64_t, 2> last_{};
  std::vector<std::uint64_t> face_ = std::vector<std::uint64_t>(16);  // its corners
  std::vector<Vec3> positions_;                                       // of these
  std::uint64_t small_faces_ = 0;
  std::uint64_t long_faces_ = 0;
};

/// What follows the header, read element by element in the file's order. Malformed records throw
/// DataError naming file, element, index and place.
class PlyBody {
 public:
  virtual ~PlyBody() = default;
  virtual void read_vertices(const PlyElement& element, Batch<Vec3>& batch) = 0;
  virtual void read_corners(const PlyElement& element, TriangleMaker& maker) = 0;
  virtual void skip(const PlyElement& element) = 0;
  /// After the last element: whether nothing (in ascii: nothing but blanks) follows.
  virtual bool at_end() = 0;
  /// Whether ascii floats were read that had more digits than a float holds.
  virtual bool has_lost_digits() const = 0;
  /// What was let pass since the last call: a line for the user, or nothing.
  virtual std::string take_oddity() = 0;
};

/// How the text of float properties is read.
enum class AsciiFloats : std::uint8_t { as_floats, as_doubles };

struct AsciiOptions {
  AsciiFloats floats = AsciiFloats::as_floats;
  unsigned threads = 1;  // 0: one a core
};

/// `stream` stands at the first byte after the header; `path` must outlive the body.
std::unique_ptr<PlyBody> make_binary_body(std::unique_ptr<ByteStream> stream,
                                          const std::filesystem::path& path,
                                          const PlyHeader& header);
std::unique_ptr<PlyBody> make_ascii_body(std::unique_ptr<ByteStream> stream,
                                         const std::filesystem::path& path, const PlyHeader& header,
                                         const AsciiOptions& options);

}  // namespace meshfarm
