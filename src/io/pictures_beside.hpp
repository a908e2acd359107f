// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <meshfarm/io/labels.hpp>
#include <meshfarm/staging/atomic_file.hpp>

namespace meshfarm {

/// Copies of pictures beside a mesh file that is written, named after the mesh and the picture:
/// "mesh_atlas.jpg". No copy has the name of another of the pictures, so that those of an input in
/// the same folder are not replaced.
class PicturesBeside {
 public:
  PicturesBeside(const std::filesystem::path& mesh, PictureFiles pictures);

  /// The name of a picture's copy, one word; the same for each call. The copy will be written.
  const std::string& name_of(std::size_t picture);
  /// Writes copies under temporary names. Throws IoError, or DataError.
  void finish();
  /// If there are very many copies, the last are written only here.
  void commit();

 private:
  std::string free_name(std::size_t picture);
  bool is_of_another(const std::string& name, std::size_t picture) const;
  std::unique_ptr<AtomicFile> copy_of(std::size_t picture, const std::string& name) const;

  std::filesystem::path folder_;
  std::string before_;  // prefix of each name
  PictureFiles pictures_;
  std::set<std::string> taken_;
  std::map<std::size_t, std::string> names_;
  std::vector<std::unique_ptr<AtomicFile>> files_;  // of the first of these
};

}  // namespace meshfarm
