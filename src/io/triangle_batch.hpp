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

/// Collects triangles and hands them on in batches, with labels if it was told one before the
/// first. Where there are none they cost nothing.
class TriangleBatch {
 public:
  using Take = std::function<void(const TriangleView&)>;

  /// `take` must outlive this.
  explicit TriangleBatch(const Take& take) : take_(take), triangles_(k_most) {}

  /// Of what is added from now on.
  void label(Label label) {
    if (label == label_ && !labels_.empty()) return;
    fill_labels();
    label_ = label;
  }
  void add(const WideTriangle& triangle) {
    triangles_[size_] = triangle;
    added(1);
  }
  /// Room for triangles that the caller writes and then counts with added(), or added_with_labels()
  /// if it wrote as many labels.
  std::span<WideTriangle> room() { return std::span(triangles_).subspan(size_); }
  std::span<Label> label_room() {
    fill_labels();
    return std::span(labels_).subspan(size_);
  }
  void added(std::size_t count) {
    size_ += count;
    if (size_ == k_most) flush();
  }
  void added_with_labels(std::size_t count) {
    labelled_ = size_ + count;
    added(count);
  }
  void flush() {
    if (!labels_.empty()) fill_labels();
    if (size_ > 0)
      take_({std::span(triangles_).first(size_), {std::span(labels_).first(labelled_), {}}});
    size_ = 0;
    labelled_ = 0;
  }

 private:
  void fill_labels() {
    labels_.resize(k_most);
    std::fill(labels_.data() + labelled_, labels_.data() + size_, label_);
    labelled_ = size_;
  }

  static constexpr std::size_t k_most = 8192;  // stays in the second-level cache
  const Take& take_;
  std::vector<WideTriangle> triangles_;
  std::vector<Label> labels_;
  std::size_t size_ = 0;
  std::size_t labelled_ = 0;  // of these
  Label label_ = 0;
};

}  // namespace meshfarm
