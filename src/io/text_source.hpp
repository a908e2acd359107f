// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/io/mesh_source.hpp>

#include "byte_stream.hpp"
#include "text_blocks.hpp"
#include "vertex_store.hpp"

namespace meshfarm {

/// A mesh file whose lines say what they are: OBJ, ascii STL. No header has their number, so they
/// are counted when the file is opened.
class TextSource : public MeshSource {
 public:
  const MeshFileInfo& info() const final { return info_; }
  void scan_vertices(const std::function<void(std::span<const Vec3>)>& take) final;

 protected:
  /// The result of a thread for a piece.
  struct Points {
    std::vector<Vec3> positions;
    bool has_lost_digits = false;
  };
  using EndsUnit = bool (*)(std::string_view text, std::size_t at);

  TextSource(InputFile file, const OpenOptions& options, std::string_view format, EndsUnit ends_at);

  /// Appends the positions of the text. `wide`: as doubles.
  virtual void parse_vertices(std::string_view text, bool wide, Points& points) const = 0;

  /// To be called once units are counted. If the first vertices already have more digits than a
  /// float holds, not all of them need to be read twice.
  void look_at_digits();

  TextBlocks blocks() const { return {file_, units_, threads_}; }
  Vec3 position_of(std::uint64_t vertex);
  [[noreturn]] void fail_changed() const;
  /// Gives each warning only once, although a file is scanned more than once.
  void warn(const std::string& line);

  const InputFile& file() const { return file_; }
  char line_end() const { return units_.line_end; }
  unsigned threads() const { return threads_; }
  MeshFileInfo& counted() { return info_; }

 private:
  void read_vertices(const VertexStore::Take& take, VertexStore::Keep keep);

  InputFile file_;
  TextUnits units_;
  unsigned threads_;
  VertexStore::Keep keep_;
  MeshFileInfo info_;
  VertexStore store_;
  std::set<std::string> warnings_;
};

/// Passes many items on in batches that stay in the near caches.
template <class T>
void take_in_batches(std::span<const T> items,
                     const std::function<void(std::span<const T>)>& take) {
  constexpr std::size_t k_batch = 8192;
  for (; !items.empty(); items = items.subspan(std::min(items.size(), k_batch))) {
    take(items.first(std::min(items.size(), k_batch)));
  }
}

}  // namespace meshfarm
