// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <meshfarm/io/mesh_source.hpp>

#include "polygon.hpp"
#include "triangle_batch.hpp"

namespace meshfarm {

/// The meaning of consecutive corners: a polygon, or a triangle strip (-1 begins another).
enum class CornerOrder : std::uint8_t { face, strip };

/// Collects items and passes them on in batches.
template <class T>
class Batch {
 public:
  using Take = std::function<void(std::span<const T>)>;

  explicit Batch(Take take) : take_(std::move(take)), items_(k_most_items) {}

  void add(const T& item) {
    items_[size_] = item;
    added(1);
  }
  /// Room for items, which the caller writes and then counts with added().
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
  Take take_;
  std::vector<T> items_;
  std::size_t size_ = 0;
};

/// Makes triangles from the corners of faces and strips. For a face with more than three corners,
/// the positions are requested; it is kept up to k_most_corners, and a longer one becomes a fan. A
/// face gets the label that the batch has when its triangles are made: at its end, or earlier if it
/// is longer than that. Its texture coordinates, if it has any, count at its end.
class TriangleMaker {
 public:
  using PositionOf = std::function<Vec3(std::uint64_t vertex)>;
  static constexpr std::size_t k_most_corners = 1 << 16;
  static constexpr std::size_t k_most_held_corners = 1 << 24;
  static constexpr const char* k_too_long_for_label =
      "it has more than 16,777,216 corners, and its label only after them";

  TriangleMaker(std::uint64_t vertices, const TriangleBatch::Take& take, PositionOf position_of)
      : vertices_(vertices), batch_(take), position_of_(std::move(position_of)) {}

  /// From now on, makes the triangles of long faces, too, at their end: their label is not known
  /// before.
  void hold_long_faces() { most_kept_ = k_most_held_corners; }
  /// From now on, triangles have texture coordinates.
  void keep_uvs() {
    hold_long_faces();
    batch_.keep_uvs();
  }
  void begin(CornerOrder order) {
    order_ = order;
    corners_ = 0;
    uvs_ = {};
  }
  /// The texture coordinates of the current face's corners; ignored unless there is one per corner.
  /// They must stay valid until its end.
  void uvs(std::span<const Uv> of_corners) { uvs_ = of_corners; }
  /// False if there is no such vertex.
  bool corner(std::int64_t index) {
    const auto vertex = static_cast<std::uint64_t>(index);
    if (vertex >= vertices_) return restart(index);
    order_ == CornerOrder::strip ? add_to_strip(vertex) : add_to_face(vertex);
    ++corners_;
    return true;
  }
  void end() {
    if (order_ != CornerOrder::face) return;
    if (corners_ < 3) {
      ++small_faces_;
    } else if (corners_ == 3) {
      put(0, 1, 2);
    } else if (corners_ <= k_most_corners) {
      cut_face();
    } else {
      ++long_faces_;
      for (std::size_t i = 1; corners_ <= most_kept_ && i + 1 < corners_; ++i) put(0, i, i + 1);
    }
  }

  /// The label of the current face, and of those that follow.
  void label(Label label) { batch_.label(label); }

  std::uint64_t vertices() const { return vertices_; }
  std::uint64_t small_faces() const { return small_faces_; }
  /// The number of faces that became fans although that may be wrong.
  std::uint64_t guessed_faces() const { return long_faces_ + cutter_.failed(); }
  /// The warning about them.
  std::string guess_warning(const std::filesystem::path& path) const {
    return path.string() + ": " + std::to_string(guessed_faces()) +
           " polygons cross themselves, or have too many corners: they may be triangulated wrongly";
  }
  TriangleBatch& batch() { return batch_; }

 private:
  bool restart(std::int64_t index) {
    corners_ = 0;
    return order_ == CornerOrder::strip && index == -1;
  }
  void add_to_face(std::uint64_t vertex) {
    if (corners_ < face_.size()) {
      face_[corners_] = vertex;
    } else if (corners_ < most_kept_) {
      face_.resize(2 * face_.size());
      face_[corners_] = vertex;
    } else {
      add_to_fan(vertex);
    }
  }
  /// Adds a corner of a face that is too long. Its first and last corners are at the ends of face_.
  void add_to_fan(std::uint64_t vertex) {
    for (std::size_t i = 1; corners_ == most_kept_ && i + 1 < corners_; ++i) {
      batch_.add({face_[0], face_[i], face_[i + 1]});
    }
    batch_.add({face_[0], face_.back(), vertex});
    face_.back() = vertex;
  }
  void cut_face() {
    positions_.clear();
    for (std::size_t i = 0; i < corners_; ++i) positions_.push_back(position_of_(face_[i]));
    for (const auto& [a, b, c] : cutter_.cut(positions_)) put(a, b, c);
  }
  /// Adds a triangle of corners of the face.
  void put(std::size_t a, std::size_t b, std::size_t c) {
    const WideTriangle triangle{face_[a], face_[b], face_[c]};
    if (uvs_.empty() || uvs_.size() != corners_) {
      batch_.add(triangle);
    } else {
      batch_.add(triangle, {uvs_[a], uvs_[b], uvs_[c]});
    }
  }
  void add_to_strip(std::uint64_t vertex) {
    if (corners_ < 2) {
      last_[corners_] = vertex;
      return;
    }
    // Every second triangle of a strip has the opposite orientation. A repeated vertex joins strips
    // and makes no face.
    const bool odd = corners_ % 2 != 0;
    if (last_[0] != last_[1] && last_[1] != vertex && last_[0] != vertex) {
      batch_.add({last_[odd ? 1 : 0], last_[odd ? 0 : 1], vertex});
    }
    last_ = {last_[1], vertex};
  }

  std::uint64_t vertices_;
  TriangleBatch batch_;
  PositionOf position_of_;
  PolygonCutter cutter_;
  CornerOrder order_ = CornerOrder::face;
  std::uint64_t corners_ = 0;
  std::uint64_t most_kept_ = k_most_corners;  // of a face
  std::array<std::uint64_t, 2> last_{};
  std::vector<std::uint64_t> face_ = std::vector<std::uint64_t>(16);  // its corners
  std::vector<Vec3> positions_;                                       // of these
  std::span<const Uv> uvs_;                                           // of these
  std::uint64_t small_faces_ = 0;
  std::uint64_t long_faces_ = 0;
};

/// Takes corners like a TriangleMaker, and the labels and texture coordinates of faces, to pass
/// them on to one later.
class CornerRecord {
 public:
  explicit CornerRecord(std::uint64_t vertices) : vertices_(vertices) {}

  void begin(CornerOrder order) {
    order_ = order;
    lengths_.push_back(0);
  }
  bool corner(std::int64_t index) {
    if (static_cast<std::uint64_t>(index) >= vertices_ &&
        (order_ != CornerOrder::strip || index != -1)) {
      return false;
    }
    corners_.push_back(index);
    ++lengths_.back();
    return true;
  }
  void end() {}
  /// The label of the current face. Either all have one, or none has.
  void label(Label label) { labels_.push_back(label); }
  void uvs(std::span<const Uv> of_corners) {
    uv_lengths_.resize(lengths_.size());
    uv_lengths_.back() = static_cast<std::uint32_t>(of_corners.size());
    uvs_.insert(uvs_.end(), of_corners.begin(), of_corners.end());
  }
  std::uint64_t vertices() const { return vertices_; }

  void play(TriangleMaker& maker) const {
    const std::int64_t* next = corners_.data();
    std::span<const Uv> uvs(uvs_);
    for (std::size_t face = 0; face < lengths_.size(); ++face) {
      maker.begin(order_);
      if (!labels_.empty()) maker.label(labels_[face]);
      if (face < uv_lengths_.size()) {
        maker.uvs(uvs.first(uv_lengths_[face]));
        uvs = uvs.subspan(uv_lengths_[face]);
      }
      for (std::uint32_t i = 0; i < lengths_[face]; ++i) maker.corner(*next++);
      maker.end();
    }
  }

 private:
  std::uint64_t vertices_;
  CornerOrder order_ = CornerOrder::face;
  std::vector<std::uint32_t> lengths_;
  std::vector<std::int64_t> corners_;
  std::vector<Label> labels_;
  std::vector<std::uint32_t> uv_lengths_;  // of the faces up to the last that has any
  std::vector<Uv> uvs_;
};

}  // namespace meshfarm
