// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "gltf_column.hpp"
#include "gltf_meshes.hpp"
#include "scratch_array.hpp"
#include "triangle_batch.hpp"

namespace meshfarm {

/// The texture coordinates of a primitive's vertices: up to 48 MB in memory, more in a scratch
/// file.
class GltfPlaces {
 public:
  explicit GltfPlaces(const GltfUvs& uvs) : uvs_(uvs), places_(uvs.column.rows) {
    GltfColumnReader reader;
    std::vector<std::array<double, 4>> rows;
    const std::uint64_t count = uvs.column.rows;
    for (std::uint64_t done = 0; done < count; done += rows.size()) {
      rows.resize(std::min<std::uint64_t>(count - done, GltfColumnReader::k_most_rows));
      reader.read(uvs.column, done, rows);
      std::transform(rows.begin(), rows.end(),
                     places_.items().begin() + static_cast<std::ptrdiff_t>(done),
                     [this](const auto& row) { return mapped(row[0], row[1]); });
      places_.used(rows.size());
    }
  }
  /// Whether these were made from the same: many primitives may share theirs.
  bool are_of(const GltfUvs& uvs) const {
    return uvs_.column.buffer == uvs.column.buffer && uvs_.column.start == uvs.column.start &&
           uvs_.column.rows == uvs.column.rows && uvs_.column.stride == uvs.column.stride &&
           uvs_.column.type == uvs.column.type && uvs_.column.normalized == uvs.column.normalized &&
           uvs_.a == uvs.a && uvs_.b == uvs.b;
  }
  const Uv& at(std::uint64_t vertex) {
    places_.used(1);
    return places_.items()[vertex];
  }

 private:
  Uv mapped(double u, double v) const {
    Uv made{static_cast<float>(u * uvs_.a[0] + v * uvs_.a[1] + uvs_.a[2]),
            static_cast<float>(u * uvs_.b[0] + v * uvs_.b[1] + uvs_.b[2])};
    for (float& each : made) {
      if (uvs_.are_finite && !std::isfinite(each)) each = 0;
    }
    return made;
  }

  GltfUvs uvs_;
  ScratchArray<Uv> places_;
};

/// Makes triangles from the corners of a primitive.
class GltfCorners {
 public:
  GltfCorners(const GltfTriangles& triangles, std::uint64_t first, bool is_mirror,
              TriangleBatch& batch)
      : mode_(triangles.mode), first_(first), is_mirror_(is_mirror), batch_(batch) {}
  /// The texture coordinates of the triangles; must outlive this.
  void place(GltfPlaces& places) { places_ = &places; }

  void add(std::span<const std::uint32_t> vertices) {
    const bool are_plain =
        mode_ == GltfMode::triangles && count_ % 3 == 0 && !is_mirror_ && places_ == nullptr;
    std::size_t i = 0;
    for (; are_plain && i + 3 <= vertices.size(); i += 3) {
      batch_.add({first_ + vertices[i], first_ + vertices[i + 1], first_ + vertices[i + 2]});
    }
    for (; i < vertices.size(); ++i) add(vertices[i]);
  }

  void add(std::uint64_t vertex) {
    switch (mode_) {
      case GltfMode::triangles:
        if (count_ % 3 == 2) put(last_[0], last_[1], vertex);
        break;
      case GltfMode::strip:
        // Every second one has the opposite orientation; two equal corners join strips.
        if (count_ >= 2 && last_[0] != last_[1] && last_[1] != vertex && last_[0] != vertex) {
          count_ % 2 == 0 ? put(last_[0], last_[1], vertex) : put(last_[1], last_[0], vertex);
        }
        break;
      case GltfMode::fan:
        if (count_ == 0) hub_ = vertex;
        if (count_ >= 2) put(hub_, last_[1], vertex);
        break;
    }
    last_ = {last_[1], vertex};
    ++count_;
  }

 private:
  void put(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    if (is_mirror_) std::swap(b, c);
    const WideTriangle triangle{first_ + a, first_ + b, first_ + c};
    if (places_ == nullptr) {
      batch_.add(triangle);
    } else {
      batch_.add(triangle, {places_->at(a), places_->at(b), places_->at(c)});
    }
  }

  GltfMode mode_;
  std::uint64_t first_;
  bool is_mirror_;
  TriangleBatch& batch_;
  GltfPlaces* places_ = nullptr;
  std::array<std::uint64_t, 2> last_{};
  std::uint64_t hub_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace meshfarm
