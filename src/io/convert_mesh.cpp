// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <vector>

#include <meshfarm/io/convert_mesh.hpp>
#include <meshfarm/io/mesh_format.hpp>

namespace meshfarm {
namespace {

/// The vertices that have no position. Uses no memory before the first of them.
class WithoutPosition {
 public:
  void add(std::uint64_t first, std::span<const Vec3> batch) {
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (has_position(batch[i])) continue;
      lacks_.resize(std::max<std::uint64_t>(lacks_.size(), first + i + 1));
      lacks_[first + i] = true;
    }
  }
  bool has_any_of(const WideTriangle& triangle) const {
    return std::any_of(triangle.begin(), triangle.end(),
                       [this](std::uint64_t v) { return v < lacks_.size() && lacks_[v]; });
  }
  bool empty() const { return lacks_.empty(); }

 private:
  std::vector<bool> lacks_;
};

class Conversion {
 public:
  Conversion(MeshSource& source, const std::function<void(double)>& progress)
      : source_(source), progress_(progress) {}

  Converted write(const std::filesystem::path& output, Packing packing) {
    count_vertices();
    scan_triangles([&](const TriangleView& batch) { made_.triangles += batch.size(); });
    made_.small_faces = source_.small_faces();
    made_.dropped_not_finite = dropped_;
    made_.channels = kept_channels(output, source_.info().channels);
    made_.has_labels = source_.info().labels && keeps_labels(output);
    made_.has_uvs = source_.info().uvs && keeps_uvs(output);
    const auto sink = create_mesh(output, {.vertices = made_.vertices,
                                           .triangles = made_.triangles,
                                           .positions = made_.positions,
                                           .comment = {},
                                           .channels = source_.info().channels,
                                           .labels = source_.info().labels,
                                           .packing = packing,
                                           .uvs = source_.info().uvs,
                                           .pictures = source_.info().pictures});
    write_vertices(*sink);
    scan_triangles([&](const TriangleView& batch) { sink->triangles(batch); });
    sink->commit();
    return made_;
  }

 private:
  void write_vertices(MeshSink& sink) {
    if (source_.info().channels.empty()) {
      return source_.scan_vertices([&](std::span<const Vec3> batch) {
        sink.vertices(batch);
        tell(batch.size());
      });
    }
    source_.scan_channels([&](const ChannelPoints& batch) {
      sink.vertices(batch.points, batch.values);
      tell(batch.points.size());
    });
  }

  void count_vertices() {
    do {
      made_.positions = source_.info().positions;
      made_.vertices = 0;
      without_ = {};
      source_.scan_vertices([&](std::span<const Vec3> batch) {
        without_.add(made_.vertices, batch);
        made_.vertices += batch.size();
        tell(batch.size());
      });
    } while (source_.info().positions != made_.positions);
  }

  /// Shows only triangles whose vertices all have positions.
  void scan_triangles(const std::function<void(const TriangleView&)>& take) {
    dropped_ = 0;
    source_.scan_triangles([&](const TriangleView& batch) {
      tell(batch.size());
      if (without_.empty()) return take(batch);
      kept_.clear();
      kept_columns_.clear();
      for (std::size_t i = 0; i < batch.size(); ++i) {
        if (without_.has_any_of(batch.corners[i])) continue;
        kept_.push_back(batch.corners[i]);
        kept_columns_.append(batch.columns, i);
      }
      dropped_ += batch.size() - kept_.size();
      take({kept_, kept_columns_});
    });
  }

  /// Everything is scanned twice. It is an estimate, as polygons have more triangles than faces.
  void tell(std::size_t more) {
    done_ += more;
    const MeshFileInfo& info = source_.info();
    const double all = 2 * (static_cast<double>(info.vertices) + static_cast<double>(info.faces));
    progress_(std::min(1.0, static_cast<double>(done_) / std::max(1.0, all)));
  }

  MeshSource& source_;
  const std::function<void(double)>& progress_;
  Converted made_;
  WithoutPosition without_;
  std::vector<WideTriangle> kept_;  // of a batch
  TriangleColumns kept_columns_;    // and their columns
  std::uint64_t dropped_ = 0;
  std::uint64_t done_ = 0;
};

}  // namespace

Converted convert_mesh(MeshSource& source, const std::filesystem::path& output,
                       const std::function<void(double)>& progress, Packing packing) {
  return Conversion(source, progress).write(output, packing);
}

}  // namespace meshfarm
