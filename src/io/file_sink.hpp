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

/// The path, if a file can be made there: fails before the work, not after it. Throws IoError.
const std::filesystem::path& checked_output(const std::filesystem::path& path);

/// What the writers of all formats share: the file, its checks, and the counts. A format only
/// encodes.
class FileSink : public MeshSink {
 public:
  /// Throws IoError if the file cannot be made, UsageError for a comment of more than a line.
  FileSink(const std::filesystem::path& path, const MeshSinkOptions& options);

  void vertices(std::span<const Vec3> batch) final;
  void vertices(std::span<const Vec3> batch, std::span<const float> values) final;
  void triangles(const TriangleView& batch) final;
  void triangles(std::span<const Triangle> batch, const TriangleColumnsView& columns) final;
  void commit() final;

 protected:
  /// Of checked counts and indices, k_most_at_once at most.
  /// Formats that have no place for the channels' values, or for columns, leave them out.
  virtual void put(std::span<const Vec3> batch, std::span<const float> values) = 0;
  virtual void put(const TriangleView& batch) = 0;
  /// When all is put.
  virtual void finish() {}

  static constexpr std::size_t k_most_at_once = 8192;
  const std::filesystem::path& path() const { return path_; }
  const MeshSinkOptions& options() const { return options_; }
  void write(std::string_view bytes) { file_.write(bytes); }
  /// What is written is on the disk then.
  void sync() { file_.sync(); }
  /// Of a file that comes after others which it names: one that is there already must not be found
  /// with the new ones. It goes when what is written is on the disk, and only renaming is left.
  void make_way();
  /// In the place of bytes that were written before.
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
