// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include <meshfarm/io/mesh_sink.hpp>
#include <meshfarm/staging/atomic_file.hpp>

namespace meshfarm {

/// Returns the path if a file can be created there; so it fails before the work, not after it.
/// Throws IoError.
const std::filesystem::path& checked_output(const std::filesystem::path& path);

/// The common part of the writers of all formats: the file, its checks, and the counts. A format
/// only encodes.
class FileSink : public MeshSink {
 public:
  /// Throws IoError if the file cannot be created, UsageError for a comment of more than one line.
  FileSink(const std::filesystem::path& path, const MeshSinkOptions& options);

  void vertices(std::span<const Vec3> batch) final;
  void vertices(std::span<const Vec3> batch, std::span<const float> values) final;
  void triangles(const TriangleView& batch) final;
  void triangles(std::span<const Triangle> batch, const TriangleColumnsView& columns) final;
  void commit() final;

 protected:
  /// Get checked counts and indices, at most k_most_at_once at a time. Formats that have no place
  /// for the channels' values, or for columns, leave them out.
  virtual void put(std::span<const Vec3> batch, std::span<const float> values) = 0;
  virtual void put(const TriangleView& batch) = 0;
  /// Called after the last put().
  virtual void finish() {}

  static constexpr std::size_t k_most_at_once = 8192;
  const std::filesystem::path& path() const { return path_; }
  const MeshSinkOptions& options() const { return options_; }
  void write(std::string_view bytes) { file_.write(bytes); }
  /// Afterwards, what was written is on the disk.
  void sync() { file_.sync(); }
  /// For a file that is committed after other files which it names: an old file of its name must
  /// not be found together with these new ones. It is removed once what was written is on the disk
  /// and only renaming is left.
  void make_way();
  /// Replaces bytes that were written before.
  void overwrite(std::uint64_t offset, std::string_view bytes) { file_.overwrite(offset, bytes); }

 private:
  std::uint64_t counted(std::uint64_t before, std::uint64_t more, std::uint64_t promised,
                        const char* what) const;
  void check_count(std::uint64_t written, std::uint64_t promised, const char* what) const;
  void check_indices(std::span<const WideTriangle> batch) const;
  void check_columns(const TriangleView& batch) const;

  std::filesystem::path path_;
  MeshSinkOptions options_;
  AtomicFile file_;
  std::vector<WideTriangle> wide_;  // of a batch
  std::uint64_t vertices_ = 0;
  std::uint64_t triangles_ = 0;
};

}  // namespace meshfarm
