// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <support/temp_folder.hpp>

#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/util/errors.hpp>

#include "ply_test_files.hpp"

namespace meshfarm::test {

using Names = std::vector<std::string>;

/// A mesh file and the files beside it.
class UvModel {
 public:
  UvModel(std::string name, const std::string& bytes) : name_(std::move(name)) {
    with(name_, bytes);
  }
  UvModel& with(const std::string& name, const std::string& bytes) {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    write_file(path, bytes);
    return *this;
  }
  std::filesystem::path path() const { return folder_ / name_; }
  /// Keeps the textures.
  std::unique_ptr<MeshSource> open(unsigned threads = 2) const {
    return open_mesh(path(), {.threads = threads, .textures = Textures::keep});
  }

 private:
  TempFolder folder_;
  std::string name_;
};

struct UvTriangles {
  std::vector<WideTriangle> corners;
  std::vector<Label> labels;
  std::vector<CornerUvs> uvs;
};

/// The triangles of one scan; checks that they have the columns that the source announces.
inline UvTriangles triangles_of(MeshSource& source) {
  UvTriangles made;
  source.scan_triangles([&](const TriangleView& batch) {
    REQUIRE(batch.columns.fits(source.info().columns(), batch.size()));
    made.corners.insert(made.corners.end(), batch.corners.begin(), batch.corners.end());
    const auto& [labels, uvs] = batch.columns;
    made.labels.insert(made.labels.end(), labels.begin(), labels.end());
    made.uvs.insert(made.uvs.end(), uvs.begin(), uvs.end());
  });
  return made;
}

/// The message of the DataError that `use` throws, from the file's name on.
template <class Use>
std::string error_of(const Use& use) {
  try {
    use();
  } catch (const DataError& error) {
    const std::string text = error.what();
    return text.substr(text.rfind('/', text.find(": ")) + 1);
  }
  return "no error";
}

}  // namespace meshfarm::test
