// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The input:
//   "v" x y z [w | r g b [a]]
//   "f" { v["/"[vt]["/"[vn]]] }   from 1, or backwards from the last vertex before the line: -1
//   "vt" u [v]                    if textures are kept
//   "usemtl" name                 of the faces that follow; or "g" or "o", if there is none
// Textures are read by obj_textures.cpp. All other statements are counted and skipped. '#' begins a
// comment, and a backslash at the end of a line joins the next line to it.
#include "obj_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <meshfarm/util/errors.hpp>

#include "face_list.hpp"
#include "obj_maps.hpp"
#include "obj_places.hpp"
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

/// The vertices, or texture coordinates, that a face may use.
struct IndexRange {
  std::uint64_t before = 0;  // their number before the face
  std::uint64_t all = 0;
};

std::uint64_t checked_index(const TextScanner& scanner, std::int64_t index, const IndexRange& range,
                            const char* name, const char* items) {
  const std::uint64_t end = index < 0 ? std::min(range.before, range.all) : range.all;
  const std::uint64_t made = obj_index(index, range.before);
  if (made < end) return made;
  scanner.fail(std::string(name) + " index " + std::to_string(index) +
               " is out of range: there are " + std::to_string(end) + " " + items +
               (index < 0 ? " before" : ""));
}

struct CornerWords {
  std::uint64_t vertex = 0;
  std::string_view more;  // "/1/3"
};

/// A corner: "7", "7/1", "7//3", "7/1/3", "-1//-1".
CornerWords read_corner(TextScanner& scanner, const IndexRange& vertices) {
  std::int64_t index = 0;
  const char* stop = read_number(scanner.at(), scanner.limit(), index);
  const bool has_number = stop != nullptr;
  const char* const more = stop;
  const auto goes_on = [](char c) { return c == '/' || c == '-' || (c >= '0' && c <= '9'); };
  if (has_number && stop != scanner.limit() && *stop == '/') {
    while (stop != scanner.limit() && goes_on(*stop)) ++stop;
  }
  if (!has_number || !scanner.ends_value(stop)) {
    scanner.fail("the corner " + scanner.token() + " of a face has no whole number for its vertex");
  }
  const std::uint64_t vertex = checked_index(scanner, index, vertices, "vertex", "vertices");
  scanner.go_to(stop);
  return {vertex, {more, static_cast<std::size_t>(stop - more)}};
}

/// (0, 0) if the corner has none, or none that is finite. `more`: the text after its vertex.
Uv read_corner_uv(const TextScanner& scanner, std::string_view more, const ObjPlaces& places,
                  std::uint64_t before) {
  if (more.size() < 2 || more[1] == '/') return {};
  const std::string_view word = more.substr(1, more.find('/', 1) - 1);
  std::int64_t index = 0;
  const char* const end = word.data() + word.size();
  if (read_number(word.data(), end, index) != end) {
    scanner.fail("the corner of a face has " + shown(word) + " as its texture coordinates");
  }
  Uv uv = places.at(checked_index(scanner, index, {before, places.size()}, "texture coordinate",
                                  "texture coordinates"));
  for (float& each : uv) {
    if (!std::isfinite(each)) each = 0;
  }
  return uv;
}

class ObjSource final : public TextSource {
 public:
  ObjSource(InputFile file, const OpenOptions& options)
      : TextSource(std::move(file), options, "OBJ", ends_statement) {
    ObjStatements all;
    all.begin_text();
    const FacePlaces places =
        options.textures == Textures::keep ? FacePlaces::looked_for : FacePlaces::passed_over;
    TextBlocks text = blocks();
    for_pieces<ObjStatements>(
        text, threads(),
        [this, places](std::string_view piece, ObjStatements& made) {
          made = {};
          made.count(piece, line_end(), places);
        },
        [&all](const ObjStatements& made) { all.add(made); });
    has_relative_ = all.has_relative;
    counted().vertices = all.vertices;
    counted().faces = all.faces;
    place_count_ = all.has_places ? all.count_of("vt") : 0;
    counted().uvs = place_count_ > 0;
    look_at_digits();
    read_materials(all, options);
    find_skipped(all, options);
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
    if (maps_.moves.empty()) return scan_unmoved(take);
    MovedUvs moved(maps_.moves);
    scan_unmoved([&](const TriangleView& batch) { take(moved.of(batch)); });
  }

 private:
  struct Faces {
    ObjCounts before;  // before the piece; known if there are relative indices
    FaceList faces;
    std::vector<std::uint64_t> corners;  // of a face
    std::vector<Uv> uvs;                 // of these
    std::size_t places = 0;              // number of lookups
  };

  /// With the texture coordinates of the file.
  void scan_unmoved(const std::function<void(const TriangleView&)>& take) {
    TriangleMaker maker(info().vertices, take, [this](std::uint64_t v) { return position_of(v); });
    if (info().labels) maker.label(label_names_.label_of("").value_or(0));
    if (info().uvs) {
      maker.keep_uvs();
      if (!places_) places_.emplace(obj_text(), place_count_);
    }
    TextBlocks text = blocks();
    ObjCounts before;
    for_pieces<Faces>(
        text, threads(),
        [&](std::span<const std::string_view> pieces, std::span<Faces> made) {
          if (!has_relative_) return;
          const std::vector<ObjCounts> counts = counts_before(pieces, obj_text(), before);
          for (std::size_t i = 0; i < counts.size(); ++i) made[i].before = counts[i];
        },
        [this](std::string_view piece, Faces& made) { parse_faces(piece, made); },
        [&](const Faces& made) {
          made.faces.play(maker);
          if (places_) places_->used(made.places);
        });
    maker.batch().flush();
    small_faces_ = maker.small_faces();
    if (maker.guessed_faces() > 0) warn(maker.guess_warning(file().path()));
  }

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
    const bool may_have_textures =
        options.channels &&
        (options.textures == Textures::bake || options.textures == Textures::name) &&
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
      if (info().uvs) keep_maps(all.materials, materials);
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
      texture_colours_ = sample_obj_textures(obj_text(), all, materials, options.picture_bytes);
      if (!texture_colours_) return;
    }
    counted().textures =
        describe(materials.images,
                 options.textures == Textures::bake ? LostPictures::left : LostPictures::told);
  }

  void keep_maps(const ObjNames& names, std::span<const ObjLibraryMaterial> materials) {
    maps_ = keep_obj_maps(file().path(), names, materials, *counted().labels,
                          [this](const std::string& line) { warn(line); });
    counted().pictures = std::move(maps_.pictures);
  }

  void find_skipped(const ObjStatements& all, const OpenOptions& options) {
    std::vector<std::string_view> read = label_words_;
    if (info().uvs) read.emplace_back("vt");
    std::vector<std::string>& skipped = counted().skipped;
    skipped = all.skipped_names(options.channels, read);
    skipped.insert(skipped.end(), maps_.skipped.begin(), maps_.skipped.end());
  }

  ObjText obj_text() const { return {file(), {line_end(), ends_statement}, threads()}; }

  /// Where there is a texture, its colours replace those of the vertices: writers that have both
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

  /// Colours are numbers up to 1. Vertices without one are white.
  void parse_colours(std::string_view text, bool wide, ChannelPoints& made) const {
    made.points.clear();
    made.values.clear();
    TextScanner scanner(text, line_end());
    for (; scanner.next_value(); scanner.next_line()) {
      if (scanner.word() != "v") continue;
      made.points.push_back(read_position(scanner, wide));
      std::array<double, 3> colour{};
      std::size_t count = 0;
      while (count < colour.size() && scanner.has_value()) colour[count++] = scanner.real(true);
      for (const double level : colour) {
        made.values.push_back(static_cast<float>((count < 3 ? 1.0 : level) * 255));
      }
    }
  }

  void parse_faces(std::string_view text, Faces& made) const {
    made.faces.clear();
    made.places = 0;
    IndexRange vertices{made.before.vertices, info().vertices};
    std::uint64_t places_before = made.before.places;
    const std::string_view label_word = label_words_.empty() ? "" : label_words_.front();
    TextScanner scanner(text, line_end());
    for (; scanner.next_value(); scanner.next_line()) {
      const std::string_view word = scanner.word();
      if (word == "v") ++vertices.before;
      if (word == "vt") ++places_before;
      if (word == label_word) {
        const auto label = label_names_.label_of(rest_of_line(scanner.at(), text, line_end()));
        if (label) made.faces.label(*label);
      }
      if (word != "f") continue;
      made.corners.clear();
      made.uvs.clear();
      while (scanner.has_value()) {
        const CornerWords corner = read_corner(scanner, vertices);
        made.corners.push_back(corner.vertex);
        if (!places_) continue;
        made.uvs.push_back(read_corner_uv(scanner, corner.more, *places_, places_before));
      }
      made.faces.add(made.corners, made.uvs);
      made.places += made.uvs.size();
    }
  }

  bool has_relative_ = false;
  std::uint64_t place_count_ = 0;  // of texture coordinates, if triangles are to have them
  std::optional<ObjPlaces> places_;
  ObjMaps maps_;
  std::uint64_t small_faces_ = 0;
  std::unique_ptr<TextureColours> texture_colours_;
  ObjNames label_names_;
  std::vector<std::string_view> label_words_;  // read for labels; the one that names them first
};

}  // namespace

std::unique_ptr<MeshSource> open_obj(InputFile file, const OpenOptions& options) {
  return std::make_unique<ObjSource>(std::move(file), options);
}

}  // namespace meshfarm
