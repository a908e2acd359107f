// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Read in addition to what obj_reader.cpp reads; names extend to the end of the line:
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

#include "kept_pictures.hpp"
#include "mtl.hpp"
#include "polygon.hpp"
#include "srgb.hpp"
#include "text_scanner.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_no_place = UINT64_MAX;

float linear_of(double level) {
  return static_cast<float>(linear_of_srgb(level));
}

/// With a picture, the colour is ignored: many writers then give an arbitrary one, or black.
TextureMaterial made_of(const MtlMaterial& material) {
  TextureMaterial made;
  for (std::size_t i = 0; i < 3; ++i) made.plain[i] = linear_of(material.colour[i]);
  made.wrap_u = made.wrap_v = material.map.is_clamped ? TextureWrap::clamp : TextureWrap::repeat;
  made.a = {material.map.scale[0], 0, material.map.offset[0]};
  made.b = {0, -material.map.scale[1], 1 - material.map.offset[1]};
  return made;
}

/// "7", "-1": an index from 1, or backwards from the last of `before`. Null if it is none.
const char* read_index(const char* at, const char* end, std::uint64_t before,
                       std::uint64_t& index) {
  std::int64_t number = 0;
  const auto [stop, error] = std::from_chars(at, end, number);
  if (error != std::errc{}) return nullptr;
  index = obj_index(number, before);
  return stop;
}

struct Corner {
  std::uint64_t vertex = 0;
  std::uint64_t place = k_no_place;
};
using CornerTriangle = std::array<Corner, 3>;

bool read_corner(std::string_view word, const ObjCounts& before, Corner& corner) {
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
        places_(text, statements.count_of("vt")) {}

  std::unique_ptr<TextureColours> run(std::uint64_t picture_bytes) {
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
    ObjCounts before;
    std::vector<CornerTriangle> triangles;
    /// The materials, by name, each with the index of its first triangle.
    std::vector<std::pair<std::size_t, std::string_view>> uses;
    std::vector<Corner> corners;  // of a face
    std::vector<Vec3> points;     // of these
    PolygonCutter cutter;
  };

  void scan(const TextureColours::IsWanted& is_wanted, const TextureColours::Add& add) {
    TextBlocks blocks = text_.blocks();
    ObjCounts before;
    std::size_t material = ObjMaterials::k_none;
    for_pieces<Piece>(
        blocks, text_.threads,
        [&](std::span<const std::string_view> pieces, std::span<Piece> made) {
          if (!statements_.has_relative) return;
          const std::vector<ObjCounts> counts = counts_before(pieces, text_, before);
          for (std::size_t i = 0; i < counts.size(); ++i) made[i].before = counts[i];
        },
        [this](std::string_view piece, Piece& made) { parse(piece, made); },
        [&](const Piece& made) { material = play(made, material, is_wanted, add); });
  }

  void parse(std::string_view text, Piece& made) {
    made.triangles.clear();
    made.uses.clear();
    ObjCounts before = made.before;
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

  void parse_face(TextScanner& scanner, const ObjCounts& before, Piece& made) {
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
    // Cut on the texture: a diagonal outside the face would colour it with what is beside it.
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
    const Uv& place = places_.at(corner.place);
    return {static_cast<double>(place[0]), static_cast<double>(place[1])};
  }

  /// Returns the material in use after the piece.
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

  const ObjText& text_;
  const ObjStatements& statements_;
  const ObjMaterials& materials_;
  ObjPlaces places_;
};

}  // namespace

ObjMaterials texture_materials(std::span<const ObjLibraryMaterial> materials) {
  ObjMaterials made;
  std::map<std::pair<std::string, std::string>, std::size_t> images;
  for (const auto& [material, folder] : materials) {
    TextureMaterial each = made_of(material);
    if (!material.map.file.empty()) {
      const auto [at, is_new] =
          images.try_emplace({folder.string(), material.map.file}, made.images.size());
      if (is_new) made.images.push_back(picture_beside(folder, material.map.file));
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
