// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// What is read beside what obj_reader.cpp reads; names go to the end of the line:
//   "mtllib" file, or { file }
//   "usemtl" name              of the faces that follow
//   "vt" u [v]                 v goes up from the picture's lower side
//   "f" { v["/"[vt]["/"[vn]]] }
#include "obj_textures.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

#include <meshfarm/util/errors.hpp>

#include "files_beside.hpp"
#include "mtl.hpp"
#include "polygon.hpp"
#include "srgb.hpp"
#include "text_scanner.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_no_place = UINT64_MAX;
using Place = std::array<float, 2>;

float linear_of(double level) {
  return static_cast<float>(linear_of_srgb(level));
}

/// With a picture the colour does not count: many writers give it at random then, or as black.
TextureMaterial made_of(const MtlMaterial& material) {
  TextureMaterial made;
  for (std::size_t i = 0; i < 3; ++i) made.plain[i] = linear_of(material.colour[i]);
  made.wrap_u = made.wrap_v = material.is_clamped ? TextureWrap::clamp : TextureWrap::repeat;
  made.a = {material.scale[0], 0, material.offset[0]};
  made.b = {0, -material.scale[1], 1 - material.offset[1]};
  return made;
}

TextureImage image_beside(const std::filesystem::path& folder, const std::string& name) {
  return {name, [folder, name] {
            const std::optional<std::filesystem::path> found = find_beside(folder, name);
            if (!found) throw DataError("no such file beside the mesh, or in a folder below");
            return read_beside(*found);
          }};
}

/// How many vertices and places come before something.
struct Counts {
  std::uint64_t vertices = 0;
  std::uint64_t places = 0;
};

/// "7", "-1": a number from 1 on, or backwards from the last of `before`. Null if it is none.
const char* read_index(const char* at, const char* end, std::uint64_t before,
                       std::uint64_t& index) {
  std::int64_t number = 0;
  const auto [stop, error] = std::from_chars(at, end, number);
  if (error != std::errc{}) return nullptr;
  index = (number < 0 ? before : ~std::uint64_t{0}) + static_cast<std::uint64_t>(number);
  return stop;
}

struct Corner {
  std::uint64_t vertex = 0;
  std::uint64_t place = k_no_place;
};
using CornerTriangle = std::array<Corner, 3>;

bool read_corner(std::string_view word, const Counts& before, Corner& corner) {
  const char* const end = word.data() + word.size();
  const char* at = read_index(word.data(), end, before.vertices, corner.vertex);
  if (at == nullptr) return false;
  corner.place = k_no_place;
  if (at + 1 < end && *at == '/' && at[1] != '/') {
    read_index(at + 1, end, before.places, corner.place);
  }
  return true;
}

class Sampling {
 public:
  Sampling(const ObjText& text, const ObjStatements& statements, const ObjMaterials& materials)
      : text_(text),
        statements_(statements),
        materials_(materials),
        places_(statements.count_of("vt")) {}

  std::unique_ptr<TextureColours> run(std::uint64_t picture_bytes) {
    read_places();
    auto colours =
        std::make_unique<TextureColours>(statements_.vertices, text_.file.path().string());
    const auto plain =
        statements_.has_colours ? TextureColours::Plain::left : TextureColours::Plain::coloured;
    const std::size_t sampled = colours->sample(
        materials_.images, materials_.materials, {.plain = plain, .picture_bytes = picture_bytes},
        [this](const TextureColours::IsWanted& is_wanted, const TextureColours::Add& add) {
          scan(is_wanted, add);
        });
    return sampled > 0 ? std::move(colours) : nullptr;
  }

 private:
  struct Piece {
    Counts before;
    std::vector<CornerTriangle> triangles;
    /// The materials, by name, and before which of the triangles they begin.
    std::vector<std::pair<std::size_t, std::string_view>> uses;
    std::vector<Corner> corners;  // of a face
    std::vector<Vec3> points;     // of them
    PolygonCutter cutter;
  };

  void read_places() {
    TextBlocks blocks = text_.blocks();
    std::uint64_t done = 0;
    for_pieces<std::vector<Place>>(
        blocks, text_.threads,
        [this](std::string_view piece, std::vector<Place>& made) {
          made.clear();
          TextScanner scanner(piece, text_.units.line_end);
          for (; scanner.next_value(); scanner.next_line()) {
            if (scanner.word() != "vt") continue;
            const float u = read_place(scanner);
            made.push_back({u, read_place(scanner)});
          }
        },
        [&](const std::vector<Place>& made) {
          if (made.size() > places_.size() - done) fail_changed();
          std::copy(made.begin(), made.end(),
                    places_.items().begin() + static_cast<std::ptrdiff_t>(done));
          done += made.size();
          places_.used(made.size());
        });
    if (done != places_.size()) fail_changed();
  }

  static float read_place(TextScanner& scanner) {
    double value = 0;
    if (!scanner.has_value()) return 0;
    const std::string_view word = scanner.word();
    if (read_number(word.data(), word.data() + word.size(), value) == nullptr) {
      return std::numeric_limits<float>::quiet_NaN();
    }
    return static_cast<float>(value);
  }

  void scan(const TextureColours::IsWanted& is_wanted, const TextureColours::Add& add) {
    TextBlocks blocks = text_.blocks();
    Counts before;
    std::size_t material = ObjMaterials::k_none;
    for_pieces<Piece>(
        blocks, text_.threads,
        [&](std::span<const std::string_view> pieces, std::span<Piece> made) {
          if (statements_.has_relative) before = count(pieces, made, before);
        },
        [this](std::string_view piece, Piece& made) { parse(piece, made); },
        [&](const Piece& made) { material = play(made, material, is_wanted, add); });
  }

  /// Tells the pieces what comes before them. Returns what comes before the next.
  Counts count(std::span<const std::string_view> pieces, std::span<Piece> made,
               Counts before) const {
    std::vector<Counts> counts(pieces.size());
    parallel_for(pieces.size(), text_.threads, [&](std::uint64_t i) {
      TextScanner scanner(pieces[i], text_.units.line_end);
      for (; scanner.next_value(); scanner.next_line()) {
        const std::string_view word = scanner.word();
        counts[i].vertices += word == "v" ? 1 : 0;
        counts[i].places += word == "vt" ? 1 : 0;
      }
    });
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      made[i].before = before;
      before.vertices += counts[i].vertices;
      before.places += counts[i].places;
    }
    return before;
  }

  void parse(std::string_view text, Piece& made) {
    made.triangles.clear();
    made.uses.clear();
    Counts before = made.before;
    TextScanner scanner(text, text_.units.line_end);
    for (; scanner.next_value(); scanner.next_line()) {
      const std::string_view word = scanner.word();
      if (word == "v") {
        ++before.vertices;
      } else if (word == "vt") {
        ++before.places;
      } else if (word == "usemtl") {
        made.uses.emplace_back(made.triangles.size(),
                               rest_of_line(scanner.at(), text, text_.units.line_end));
      } else if (word == "f") {
        parse_face(scanner, before, made);
      }
    }
  }

  void parse_face(TextScanner& scanner, const Counts& before, Piece& made) {
    made.corners.clear();
    while (scanner.has_value()) {
      Corner corner;
      if (!read_corner(scanner.word(), before, corner)) return;
      if (corner.vertex >= statements_.vertices) return;
      if (corner.place >= places_.size()) corner.place = k_no_place;
      made.corners.push_back(corner);
    }
    if (made.corners.size() < 3) return;
    if (made.corners.size() == 3) {
      made.triangles.push_back({made.corners[0], made.corners[1], made.corners[2]});
      return;
    }
    // Cut on the texture: a diagonal outside of the face would colour it by what is beside it.
    made.points.clear();
    for (const Corner& corner : made.corners) {
      const TexturePoint at = place_of(corner);
      made.points.push_back({at.u, at.v, 0});
    }
    for (const auto& [a, b, c] : made.cutter.cut(made.points)) {
      made.triangles.push_back({made.corners[a], made.corners[b], made.corners[c]});
    }
  }

  TexturePoint place_of(const Corner& corner) {
    if (corner.place == k_no_place) {
      constexpr double k_nowhere = std::numeric_limits<double>::quiet_NaN();
      return {k_nowhere, k_nowhere};
    }
    const Place& place = places_.items()[corner.place];
    return {static_cast<double>(place[0]), static_cast<double>(place[1])};
  }

  /// Returns the material of what follows.
  std::size_t play(const Piece& piece, std::size_t material,
                   const TextureColours::IsWanted& is_wanted, const TextureColours::Add& add) {
    auto use = piece.uses.begin();
    for (std::size_t i = 0; i <= piece.triangles.size(); ++i) {
      for (; use != piece.uses.end() && use->first == i; ++use) material = number_of(use->second);
      if (i == piece.triangles.size() || !is_wanted(material)) continue;
      TexturedTriangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.vertices[k] = piece.triangles[i][k].vertex;
        triangle.places[k] = place_of(piece.triangles[i][k]);
      }
      add(triangle, material);
      places_.used(3);
    }
    return material;
  }

  std::size_t number_of(std::string_view name) const {
    const auto found = materials_.numbers.find(name);
    return found == materials_.numbers.end() ? ObjMaterials::k_none : found->second;
  }

  [[noreturn]] void fail_changed() const {
    throw DataError(text_.file.path().string() + ": changed while it was read");
  }

  const ObjText& text_;
  const ObjStatements& statements_;
  const ObjMaterials& materials_;
  ScratchArray<Place> places_;
};

}  // namespace

ObjMaterials texture_materials(std::span<const ObjLibraryMaterial> materials) {
  ObjMaterials made;
  std::map<std::pair<std::string, std::string>, std::size_t> images;
  for (const auto& [material, folder] : materials) {
    TextureMaterial each = made_of(material);
    if (!material.map.empty()) {
      const auto [at, is_new] =
          images.try_emplace({folder.string(), material.map}, made.images.size());
      if (is_new) made.images.push_back(image_beside(folder, material.map));
      each.image = at->second;
    }
    made.numbers.emplace(material.name, made.materials.size());
    made.materials.push_back(each);
  }
  return made;
}

std::unique_ptr<TextureColours> sample_obj_textures(const ObjText& text,
                                                    const ObjStatements& statements,
                                                    const ObjMaterials& materials,
                                                    std::uint64_t picture_bytes) {
  return Sampling(text, statements, materials).run(picture_bytes);
}

}  // namespace meshfarm
