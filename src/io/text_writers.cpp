// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The output:
//   OBJ: ["#" comment], { "v" x y z [r g b] }, { { "vt" u v }, { "f" a[/t] b[/t] c[/t] } }, from 1;
//        colours from 0 to 1; labels as obj_labels.cpp has them. A vertex's texture coordinates
//        come once, before a batch of triangles where one has them first.
//   OFF: ["C"] "OFF", vertices triangles 0, { x y z [r g b a] }, { 3 a b c }, from 0; colours are
//        whole numbers up to 255, or floats up to 1 if the channels are
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <meshfarm/util/errors.hpp>

#include "corner_wedges.hpp"
#include "file_sink.hpp"
#include "mesh_writers.hpp"
#include "obj_labels.hpp"
#include "text_numbers.hpp"

namespace meshfarm {
namespace {

/// The differences between the lines of the formats.
struct TextForm {
  std::string_view before_vertex;
  std::string_view before_triangle;
  std::uint64_t first_index = 0;
  bool has_levels = false;   // colours as whole numbers, followed by an alpha
  bool has_columns = false;  // of triangles
};

class TextSink final : public FileSink {
 public:
  TextSink(const std::filesystem::path& path, const MeshSinkOptions& options, const TextForm& form,
           std::string_view header)
      : FileSink(path, options), form_(form), colour_(colour_columns(options.channels)) {
    write(header);
    if (!form.has_columns) return;
    if (options.uvs) wedges_.emplace(options.vertices);
    if (!options.labels) return;
    LabelMeaning meaning = *options.labels;
    if (!options.uvs) {
      for (Material& material : meaning.materials) material.maps.clear();
    }
    labels_.emplace(path, meaning, options.pictures);
    write(labels_->header());
  }

 private:
  void put(std::span<const Vec3> batch, std::span<const float> values) override {
    for (const Vec3& p : batch) {
      begin_line(form_.before_vertex);
      for (const double x : {p.x, p.y, p.z}) {
        out_ = write_coordinate(out_, x, options().positions);
        *out_++ = ' ';
      }
      if (colour_) add_colour(values.first(options().channels.size()));
      values = values.subspan(options().channels.size());
      end_line();
    }
    flush();
  }

  void add_colour(std::span<const float> of_vertex) {
    bool whole = form_.has_levels;
    for (const std::size_t column : *colour_) {
      const ChannelType type = options().channels[column].type;
      whole = form_.has_levels && type != ChannelType::float32;
      const float level = colour_level(type, of_vertex[column]);
      add_value(whole ? std::round(level * 255.0F) : level);
    }
    if (form_.has_levels) add_value(whole ? 255.0F : 1.0F);
  }

  void add_value(float value) {
    out_ = std::to_chars(out_, out_ + k_longest_coordinate, value).ptr;
    *out_++ = ' ';
  }

  void put(const TriangleView& batch) override {
    if (wedges_) add_uvs(batch);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (labels_) add_statement(batch.columns.labels[i]);
      begin_line(form_.before_triangle);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        add_index(batch.corners[i][corner] + form_.first_index);
        if (wedges_) {
          *out_++ = '/';
          add_index(uv_numbers_[3 * i + corner]);
        }
        *out_++ = ' ';
      }
      end_line();
    }
    flush();
  }

  void add_index(std::uint64_t index) {
    out_ = std::to_chars(out_, out_ + k_longest_coordinate, index).ptr;
  }

  /// Writes the texture coordinates that first occur in this batch.
  void add_uvs(const TriangleView& batch) {
    uv_numbers_.clear();
    for (std::size_t i = 0; i < batch.size(); ++i) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const Uv uv = finite_uv(batch.columns.uvs[i][corner]);
        uv_numbers_.push_back(
            wedges_->number_of(batch.corners[i][corner], uv, [&](bool /*is_first*/) {
              begin_line("vt ");
              for (const float x : uv) add_value(x);
              end_line();
              return ++uvs_;
            }));
      }
    }
    flush();
  }

  void add_statement(Label label) {
    const std::string_view statement = labels_->statement(label);
    if (statement.empty()) return;
    flush();
    write(statement);
  }

  /// The OBJ is committed last.
  void finish() override {
    if (!labels_) return;
    labels_->finish();
    make_way();
    labels_->commit();
  }

  void begin_line(std::string_view word) { out_ = std::copy(word.begin(), word.end(), out_); }
  /// Replaces the last blank.
  void end_line() { out_[-1] = '\n'; }
  void flush() {
    write({buffer_.data(), static_cast<std::size_t>(out_ - buffer_.data())});
    out_ = buffer_.data();
  }

  static constexpr std::size_t k_longest_line = 2 + 7 * (k_longest_coordinate + 1);
  TextForm form_;
  std::optional<std::array<std::size_t, 3>> colour_;  // indices among the channels
  std::optional<ObjLabels> labels_;
  std::optional<CornerWedges> wedges_;     // if there are texture coordinates
  std::uint64_t uvs_ = 0;                  // written so far
  std::vector<std::uint64_t> uv_numbers_;  // of a batch's corners
  std::vector<char> buffer_ = std::vector<char>(k_most_at_once * k_longest_line);
  char* out_ = buffer_.data();
};

}  // namespace

std::unique_ptr<MeshSink> create_obj(const std::filesystem::path& path,
                                     const MeshSinkOptions& options) {
  const std::string header = options.comment.empty() ? "" : "# " + options.comment + "\n";
  return std::make_unique<TextSink>(path, options, TextForm{"v ", "f ", 1, false, true}, header);
}

std::unique_ptr<MeshSink> create_off(const std::filesystem::path& path,
                                     const MeshSinkOptions& options) {
  const std::string header = std::string(colour_columns(options.channels) ? "COFF\n" : "OFF\n") +
                             std::to_string(options.vertices) + " " +
                             std::to_string(options.triangles) + " 0\n";
  return std::make_unique<TextSink>(path, options, TextForm{"", "3 ", 0, true, false}, header);
}

}  // namespace meshfarm
