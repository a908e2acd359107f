// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <meshfarm/io/labels.hpp>

namespace meshfarm {

/// Collects triangles and passes them on in batches, with labels if one was set before the first
/// triangle, and with texture coordinates if keep_uvs() was called. Where there are none, they cost
/// nothing.
class TriangleBatch {
 public:
  using Take = std::function<void(const TriangleView&)>;

  /// `take` must outlive this.
  explicit TriangleBatch(const Take& take) : take_(take), triangles_(k_most) {}

  /// The label of the triangles that are added from now on.
  void label(Label label) {
    if (label == label_ && !labels_.empty()) return;
    fill_labels();
    label_ = label;
  }
  /// From now on triangles have texture coordinates: those added without any have (0, 0).
  void keep_uvs() { uvs_.resize(k_most); }
  bool has_uvs() const { return !uvs_.empty(); }

  void add(const WideTriangle& triangle) {
    triangles_[size_] = triangle;
    added(1);
  }
  void add(const WideTriangle& triangle, const CornerUvs& uvs) {
    uv_room()[0] = uvs;
    wrote_uvs(1);
    add(triangle);
  }
  /// Room for triangles, which the caller writes and then counts with added(). Before that, the
  /// caller tells for how many of these it also wrote the labels or the texture coordinates.
  std::span<WideTriangle> room() { return std::span(triangles_).subspan(size_); }
  std::span<Label> label_room() {
    fill_labels();
    return std::span(labels_).subspan(size_);
  }
  std::span<CornerUvs> uv_room() {
    fill_uvs();
    return std::span(uvs_).subspan(size_);
  }
  void wrote_labels(std::size_t count) { labelled_ = size_ + count; }
  void wrote_uvs(std::size_t count) { placed_ = size_ + count; }
  void added(std::size_t count) {
    size_ += count;
    if (size_ == k_most) flush();
  }
  void flush() {
    if (!labels_.empty()) fill_labels();
    if (!uvs_.empty()) fill_uvs();
    if (size_ > 0) {
      take_({std::span(triangles_).first(size_),
             {std::span(labels_).first(labelled_), std::span(uvs_).first(placed_)}});
    }
    size_ = 0;
    labelled_ = 0;
    placed_ = 0;
  }

 private:
  void fill_labels() {
    labels_.resize(k_most);
    std::fill(labels_.data() + labelled_, labels_.data() + size_, label_);
    labelled_ = size_;
  }
  void fill_uvs() {
    std::fill(uvs_.data() + placed_, uvs_.data() + size_, CornerUvs{});
    placed_ = size_;
  }

  static constexpr std::size_t k_most = 8192;  // stays in the second-level cache
  const Take& take_;
  std::vector<WideTriangle> triangles_;
  std::vector<Label> labels_;
  std::vector<CornerUvs> uvs_;
  std::size_t size_ = 0;
  std::size_t labelled_ = 0;  // of these
  std::size_t placed_ = 0;    // how many have their texture coordinates
  Label label_ = 0;
};

}  // namespace meshfarm
