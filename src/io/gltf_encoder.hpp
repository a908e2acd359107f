// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "file_sink.hpp"
#include "gltf_document.hpp"
#include "gltf_parts.hpp"
#include "kept_vertices.hpp"

namespace meshfarm {

/// Encodes vertices and triangles; subclasses write them.
class GltfEncoder : public FileSink {
 public:
  GltfEncoder(const std::filesystem::path& path, const MeshSinkOptions& options);

 protected:
  /// Whether everything is kept until the end, which is so where triangles have columns.
  bool is_kept() const { return kept_.has_value(); }
  /// To be called after the last put(): the document's values. The layout is final from then on.
  GltfWords words(std::string uri = {});
  /// After words(): writes the vertices and triangles, if they are kept.
  void write_kept(const std::function<void(std::string_view)>& to);
  const GltfLayout& layout() const { return layout_; }
  /// To be called after the last put().
  GltfBounds bounds() const;

 private:
  virtual void write_body(std::string_view bytes) = 0;

  void put(std::span<const Vec3> batch, std::span<const float> values) override;
  void put(const TriangleView& batch) override;
  void put_split(const TriangleView& batch);
  void begin_positions(std::span<const Vec3> batch);
  char* put_position(Vec3 p, char* out);
  char* put_normal(std::span<const float> of_vertex, char* out) const;
  char* put_colour(std::span<const float> of_vertex, char* out) const;
  void write_up_to(const char* end);

  GltfLayout layout_;
  std::optional<GltfParts> parts_;
  std::optional<KeptVertices> kept_;
  std::vector<WideTriangle> split_;  // of a batch
  std::optional<Vec3> filler_;
  std::optional<Vec3> origin_;
  std::array<double, 3> lo_{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  std::array<double, 3> hi_{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  std::vector<char> buffer_;
};

}  // namespace meshfarm
