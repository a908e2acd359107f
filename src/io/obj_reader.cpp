// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// What is read:
//   "v" x y z [w] [r g b]
//   "f" { v["/"[vt]["/"[vn]]] }   from 1, or backwards from the last vertex before the line: -1
//   "usemtl" name                 of the faces that follow; or "g" or "o", if there is none
// Textures are read by obj_textures.cpp. All other statements are counted and passed over. '#'
// begins a comment, and a backslash at a line's end joins the next line to it.
#include "obj_reader.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <meshfarm/util/errors.hpp>

#include "face_list.hpp"
#include "obj_statements.hpp"
#include "obj_textures.hpp"
#include "srgb.hpp"
#include "text_scanner.hpp"
#include "text_source.hpp"

namespace meshfarm {
namespace {

bool ends_statement(std::string_view text, std::size_t at) {
  if (at > 0 && text[at - 1] == '\r') --at;
  return at == 0 || text[at - 1] != '\\';
}

/// Which vertices a face may have.
struct VertexRange {
  std::uint64_t before = 0;  // the face
  std::uint64_t all = 0;
};

/// A corner: "7", "7/1", "7//3", "7/1/3", "-1//-1".
std::uint64_t read_corner(TextScanner& scanner, const VertexRange& vertices) {
  std::int64_t index = 0;
  const char* stop = read_number(scanner.at(), scanner.limit(), index);
  const bool has_number = stop != nullptr;
  const auto goes_on = [](char c) { return c == '/' || c == '-' || (c >= '0' && c <= '9'); };
  if (has_number && stop != scanner.limit() && *stop == '/') {
    while (stop != scanner.limit() && goes_on(*stop)) ++stop;
  }
  if (!has_number || !scanner.ends_value(stop)) {
    scanner.fail("the corner " + scanner.token() + " of a face has no whole number for its vertex");
  }
  const std::uint64_t end = index < 0 ? std::min(vertices.before, vertices.all) : vertices.all;
  // What would be before the first vertex wraps around, and becomes far too large.
  const std::uint64_t vertex =
      (index < 0 ? vertices.before : ~std::uint64_t{0}) + static_cast<std::uint64_t>(index);
  if (vertex >= end) {
    scanner.fail("vertex index " + std::to_string(index) + " is out of range: there are " +
                 std::to_string(end) + (index < 0 ? " vertices before" : " vertices"));
  }
  scanner.go_to(stop);
  return vertex;
}

class ObjSource final : public TextSource {
 public:
  ObjSource(InputFile file, const OpenOptions& options)
      : TextSource(std::move(file), options, "OBJ", ends_statement) {
    ObjStatements all;
    all.begin_text();
    TextBlocks text = blocks();
    for_pieces<ObjStatements>(
        text, threads(),
        [this](std::string_view piece, ObjStatements& made) {
          made = {};
          made.count(piece, line_end());
        },
        [&all](const ObjStatements& made) { all.add(made); });
    has_relative_ = all.has_relative;
    counted().vertices = all.vertices;
    counted().faces = all.faces;
    look_at_digits();
    read_materials(all, options);
    counted().skipped = all.skipped_names(options.channels, label_words_);
    if (!options.channels || !(all.has_colours || texture_colours_)) return;
    for (const char* name : {"red", "green", "blue"}) {
      counted().channels.push_back({name, ChannelType::uint8, ChannelRole::colour});
    }
  }

  void scan_channels(const std::function<void(const ChannelPoints&)>& take) override {
    if (info().channels.empty()) return;
    const bool wide = info().positions == PositionType::float64;
    TextBlocks text = blocks();
    std::uint64_t first = 0;
    for_pieces<ChannelPoints>(
        text, threads(),
        [&](std::string_view piece, ChannelPoints& made) { parse_colours(piece, wide, made); },
        [&](ChannelPoints& made) {
          if (texture_colours_) put_textures(first, made.values);
          first += made.points.size();
          if (!made.points.empty()) take(made);
        });
  }

  std::uint64_t small_faces() const override { return small_faces_; }

  void scan_triangles(const std::function<void(const TriangleView&)>& take) override {
    TriangleMaker maker(info().vertices, take, [this](std::uint64_t v) { return position_of(v); });
    if (info().labels) maker.label(label_names_.label_of("").value_or(0));
    TextBlocks text = blocks();
    std::uint64_t before = 0;
    for_pieces<Faces>(
        text, threads(),
        [&](std::span<const std::string_view> pieces, std::span<Faces> made) {
          if (has_relative_) before = count_vertices(pieces, made, before);
        },
        [this](std::string_view piece, Faces& made) { parse_faces(piece, made); },
        [&maker](const Faces& made) { made.faces.play(maker); });
    maker.batch().flush();
    small_faces_ = maker.small_faces();
    if (maker.guessed_faces() > 0) warn(maker.guess_warning(file().path()));
  }

 private:
  struct Faces {
    std::uint64_t vertices_before = 0;  // the piece; known if there are relative indices
    FaceList faces;
    std::vector<std::uint64_t> corners;  // of a face
  };

  static Vec3 read_position(TextScanner& scanner, bool wide) {
    const double x = scanner.real(wide);
    const double y = scanner.real(wide);
    const Vec3 p{x, y, scanner.real(wide)};
    return is_finite(p) ? p : k_no_position;
  }

  void read_materials(ObjStatements& all, const OpenOptions& options) {
    const auto is_name = [](const std::string& name) { return !name.empty(); };
    const std::vector<std::string>& names = all.materials.names();
    const bool has_materials = std::any_of(names.begin(), names.end(), is_name);
    const bool may_have_textures = options.channels && options.textures != Textures::drop &&
                                   has_materials && all.count_of("vt") > 0;
    std::vector<ObjLibraryMaterial> materials;
    if (has_materials && (may_have_textures || options.labels)) {
      materials =
          read_obj_libraries(file().path(), all, [this](const std::string& line) { warn(line); });
    }
    if (may_have_textures) read_textures(all, options, texture_materials(materials));
    if (!options.labels || texture_colours_) return;
    if (has_materials) {
      if (all.materials.has_too_many()) return;
      counted().labels = meaning_of_materials(all.materials, materials);
      label_names_ = std::move(all.materials);
      label_words_ = {"usemtl", "mtllib"};
    } else {
      const bool are_groups = all.groups.names().size() > 1;
      ObjNames& groups = are_groups ? all.groups : all.objects;
      if (groups.names().size() < 2 || groups.has_too_many()) return;
      counted().labels = meaning_of_groups(groups);
      label_names_ = std::move(groups);
      label_words_ = {are_groups ? "g" : "o"};
    }
  }

  void read_textures(const ObjStatements& all, const OpenOptions& options,
                     const ObjMaterials& materials) {
    if (materials.images.empty()) return;
    if (options.textures == Textures::bake) {
      texture_colours_ = sample_obj_textures({file(), {line_end(), ends_statement}, threads()}, all,
                                             materials, options.picture_bytes);
      if (!texture_colours_) return;
    }
    counted().textures =
        describe(materials.images,
                 options.textures == Textures::bake ? LostPictures::left : LostPictures::told);
  }

  /// Where there is a texture its colours count, not those of the vertices: writers that have both
  /// mean the same by them.
  void put_textures(std::uint64_t first, std::span<float> values) {
    if (first + values.size() / 3 > info().vertices) fail_changed();
    for (std::size_t i = 0; i < values.size(); i += 3) {
      const std::optional<LinearColour> colour = texture_colours_->of(first + i / 3);
      if (!colour) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        values[i + k] = static_cast<float>(255 * srgb_of_linear(static_cast<double>((*colour)[k])));
      }
    }
  }

  void parse_vertices(std::string_view text, bool wide, Points& points) const override {
    TextScanner scanner(text, line_end());
    for (; scanner.next_value(); scanner.next_line()) {
      if (scanner.word() == "v") points.positions.push_back(read_position(scanner, wide));
    }
    points.has_lost_digits = scanner.has_lost_digits();
  }

  /// They are numbers up to 1. What has none is white.
  void parse_colours(std::string_view text, bool wide, ChannelPoints& made) const {
    made.points.clear();
    made.values.clear();
    TextScanner scanner(text, line_end());
    for (; scanner.next_value(); scanner.next_line()) {
      if (scanner.word() != "v") continue;
      made.points.push_back(read_position(scanner, wide));
      std::array<double, 4> more{};
      std::size_t count = 0;
      while (count < more.size() && scanner.has_value()) more[count++] = scanner.real(true);
      for (std::size_t i = 0; i < 3; ++i) {
        const double level = count < 3 ? 1.0 : more[count - 3 + i];
        made.values.push_back(static_cast<float>(level * 255));
      }
    }
  }

  /// Tells the pieces how many vertices come before them. Returns how many come before what
  /// follows.
  std::uint64_t count_vertices(std::span<const std::string_view> pieces, std::span<Faces> made,
                               std::uint64_t before) const {
    std::vector<std::uint64_t> counts(pieces.size());
    parallel_for(pieces.size(), threads(), [&](std::uint64_t i) {
      TextScanner scanner(pieces[i], line_end());
      for (; scanner.next_value(); scanner.next_line()) counts[i] += scanner.word() == "v" ? 1 : 0;
    });
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      made[i].vertices_before = before;
      before += counts[i];
    }
    return before;
  }

  void parse_faces(std::string_view text, Faces& made) const {
    made.faces.clear();
    VertexRange vertices{made.vertices_before, info().vertices};
    const std::string_view label_word = label_words_.empty() ? "" : label_words_.front();
    TextScanner scanner(text, line_end());
    for (; scanner.next_value(); scanner.next_line()) {
      const std::string_view word = scanner.word();
      if (word == "v") ++vertices.before;
      if (word == label_word) {
        const auto label = label_names_.label_of(rest_of_line(scanner.at(), text, line_end()));
        if (label) made.faces.label(*label);
      }
      if (word != "f") continue;
      made.corners.clear();
      while (scanner.has_value()) made.corners.push_back(read_corner(scanner, vertices));
      made.faces.add(made.corners);
    }
  }

  bool has_relative_ = false;
  std::uint64_t small_faces_ = 0;
  std::unique_ptr<TextureColours> texture_colours_;
  ObjNames label_names_;
  std::vector<std::string_view> label_words_;  // the statements that are for labels, first theirs
};

}  // namespace

std::unique_ptr<MeshSource> open_obj(InputFile file, const OpenOptions& options) {
  return std::make_unique<ObjSource>(std::move(file), options);
}

}  // namespace meshfarm
