// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "file_sink.hpp"

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

const MeshSinkOptions& checked_options(const MeshSinkOptions& options) {
  if (options.comment.find_first_of("\r\n") != std::string::npos) {
    throw UsageError("the comment of a mesh file is one line");
  }
  return options;
}

}  // namespace

const std::filesystem::path& checked_output(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (path.empty()) throw IoError("cannot write", path, ENOENT);
  if (std::filesystem::is_directory(status)) throw IoError("cannot write", path, EISDIR);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw IoError("cannot replace what is not a regular file:", path, EINVAL);
  }
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, error)) {
    const bool exists = std::filesystem::exists(folder, error);
    throw IoError("cannot write", path, exists ? ENOTDIR : ENOENT);
  }
  if (!path.has_filename()) throw IoError("cannot write", path, EISDIR);
  return path;
}

FileSink::FileSink(const std::filesystem::path& path, const MeshSinkOptions& options)
    : path_(path), options_(checked_options(options)), file_(checked_output(path)) {}

void FileSink::vertices(std::span<const Vec3> batch) {
  vertices(batch, {});
}

void FileSink::vertices(std::span<const Vec3> batch, std::span<const float> values) {
  vertices_ = counted(vertices_, batch.size(), options_.vertices, "vertices");
  const std::size_t channels = options_.channels.size();
  if (values.size() != batch.size() * channels) {
    throw UsageError("each vertex needs a value of each channel");
  }
  while (!batch.empty()) {
    const std::size_t count = std::min(batch.size(), k_most_at_once);
    put(batch.first(count), values.first(count * channels));
    batch = batch.subspan(count);
    values = values.subspan(count * channels);
  }
}

void FileSink::triangles(const TriangleView& batch) {
  check_count(vertices_, options_.vertices, "vertices");
  check_indices(batch);
  check_columns(batch);
  triangles_ = counted(triangles_, batch.size(), options_.triangles, "triangles");
  for (std::size_t first = 0; first < batch.size(); first += k_most_at_once) {
    put(batch.part(first, std::min(batch.size() - first, k_most_at_once)));
  }
}

void FileSink::triangles(std::span<const Triangle> batch, const TriangleColumnsView& columns) {
  std::size_t first = 0;
  do {
    const std::size_t count = std::min(batch.size() - first, k_most_at_once);
    wide_.clear();
    for (const Triangle& t : batch.subspan(first, count)) wide_.push_back({t[0], t[1], t[2]});
    triangles({wide_, columns.part(first, count)});
    first += count;
  } while (first < batch.size());
}

void FileSink::make_way() {
  sync();
  std::error_code error;
  std::filesystem::remove(path(), error);
  if (error) throw IoError("cannot replace", path(), error.value());
}

void FileSink::commit() {
  check_count(vertices_, options_.vertices, "vertices");
  check_count(triangles_, options_.triangles, "triangles");
  finish();
  file_.commit();
}

std::uint64_t FileSink::counted(std::uint64_t before, std::uint64_t more, std::uint64_t promised,
                                const char* what) const {
  if (more > promised - before) check_count(before + more, promised, what);
  return before + more;
}

void FileSink::check_count(std::uint64_t written, std::uint64_t promised, const char* what) const {
  if (written == promised) return;
  throw DataError(path_.string() + ": " + std::to_string(written) + " " + what +
                  " were given to be written, but " + std::to_string(promised) + " were promised");
}

void FileSink::check_indices(std::span<const WideTriangle> batch) const {
  for (const WideTriangle& triangle : batch) {
    for (const std::uint64_t index : triangle) {
      if (index < options_.vertices) continue;
      throw DataError(path_.string() + ": a triangle to be written has vertex " +
                      std::to_string(index) + " of " + std::to_string(options_.vertices));
    }
  }
}

void FileSink::check_columns(const TriangleView& batch) const {
  if (!batch.columns.fits({options_.labels.has_value(), options_.uvs}, batch.size())) {
    throw UsageError("all triangles need the columns that were promised, and no others");
  }
  const std::size_t materials = options_.labels ? options_.labels->materials.size() : 0;
  if (materials == 0) return;
  for (const Label label : batch.columns.labels) {
    if (label < materials) continue;
    throw DataError(path_.string() + ": a triangle to be written has material " +
                    std::to_string(label) + " of " + std::to_string(materials));
  }
}

}  // namespace meshfarm
