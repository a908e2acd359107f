// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "ply_reader.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "off_header.hpp"
#include "ply_body.hpp"
#include "ply_header.hpp"
#include "ply_positions.hpp"
#include "vertex_store.hpp"

namespace meshfarm {
namespace {

std::string_view name_of(PlyFormat format) {
  switch (format) {
    case PlyFormat::ascii:
      return "PLY ascii";
    case PlyFormat::binary_little:
      return "PLY binary little endian";
    case PlyFormat::binary_big:
      return "PLY binary big endian";
  }
  return "";
}

/// Floats hold every integer of 16 bits, doubles every one of 32.
PositionType position_type(const PlyElement& vertices) {
  for (const std::size_t axis : vertices.axes) {
    const PlyType type = vertices.properties[axis].type;
    if (type != PlyType::float32 && size_of(type) > 2) return PositionType::float64;
  }
  return PositionType::float32;
}

bool is_used(const PlyElement& element, std::size_t property,
             std::span<const PlyChannel> channels) {
  if (element.role != PlyRole::vertices) {
    return property == element.index_list || property == element.label;
  }
  return std::find(element.axes.begin(), element.axes.end(), property) != element.axes.end() ||
         std::any_of(channels.begin(), channels.end(),
                     [&](const PlyChannel& channel) { return channel.property == property; });
}

std::vector<std::string> skipped_names(const PlyHeader& header,
                                       std::span<const PlyChannel> channels) {
  std::vector<std::string> names;
  for (const PlyElement& element : header.elements) {
    if (element.role == PlyRole::other) {
      names.push_back(element.name + " (" + std::to_string(element.count) + " elements)");
      continue;
    }
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      if (!is_used(element, i, channels))
        names.push_back(element.name + "." + element.properties[i].name);
    }
  }
  return names;
}

/// A count is believed only as far as the file's size allows it. `at`: where the body begins.
void check_counts(const PlyHeader& header, std::uint64_t at, std::uint64_t body_bytes,
                  const std::filesystem::path& path) {
  std::uint64_t left = body_bytes;
  if (header.format == PlyFormat::ascii) ++left;  // the last line may lack its end
  for (const PlyElement& element : header.elements) {
    const std::uint64_t record = element.record_bytes(header.format);
    if (record == 0) continue;
    if (element.count > left / record) {
      const bool varies = header.format == PlyFormat::ascii || element.has_lists();
      throw DataError(path.string() + ": truncated, or the header is wrong: it claims " +
                      std::to_string(element.count) + " records of element " + element.name +
                      " of " + std::to_string(record) + (varies ? " bytes or more" : " bytes") +
                      ", but the file ends at byte " + std::to_string(at + body_bytes) + ", in " +
                      element.name + " " + std::to_string(left / record) + " at the latest");
    }
    left -= element.count * record;
  }
}

/// PLY files, and those whose header says as much in other words: OFF.
class PlySource final : public MeshSource {
 public:
  using ParseHeader = PlyHeader (*)(std::string_view start, const std::filesystem::path& path);

  PlySource(InputFile file, const OpenOptions& options, ParseHeader parse_header)
      : file_(std::move(file)), options_(options) {
    const std::unique_ptr<ByteStream> stream = file_.open();
    const std::string_view start = stream->window(ByteStream::k_max_window_bytes);
    header_ = parse_header(start.substr(0, ByteStream::k_max_window_bytes), file_.path());
    for (const std::string& oddity : header_.oddities) warn(oddity);
    stream->consume(header_.size_bytes);
    if (const std::optional<std::uint64_t> body_bytes = stream->remaining()) {
      check_counts(header_, header_.size_bytes, *body_bytes, file_.path());
    }
    fill_info();
    if (has_more_digits_than_floats()) read_as_doubles();
  }

  const MeshFileInfo& info() const override { return info_; }
  std::uint64_t small_faces() const override { return small_faces_; }

  void scan_vertices(const std::function<void(std::span<const Vec3>)>& take) override {
    if (store_.is_filled()) return store_.scan(take);
    parked_ = read_vertices(take, is_worth_keeping() ? Keep::where_possible : Keep::no);
  }

  void scan_channels(const std::function<void(const ChannelPoints&)>& take) override {
    const std::unique_ptr<PlyBody> body = open_body();
    std::size_t next = 0;
    while (header_.elements[next].role != PlyRole::vertices) body->skip(header_.elements[next++]);
    ChannelBatch batch(take);
    body->read_channels(header_.elements[next], channels_, batch);
  }

  void scan_triangles(const std::function<void(const TriangleView&)>& take) override {
    // Goes on where the last scan of the vertices stopped, if that is before all triangles.
    auto [body, next] = std::exchange(parked_, {});
    const auto first = std::find_if(header_.elements.begin(), header_.elements.end(), has_corners);
    if (!body || first - header_.elements.begin() < static_cast<std::ptrdiff_t>(next)) {
      body = open_body();
      next = 0;
    }
    TriangleMaker maker(info_.vertices, take, [this](std::uint64_t v) { return position_of(v); });
    if (std::any_of(header_.elements.begin(), header_.elements.end(),
                    [](const PlyElement& element) { return element.has_late_label(); })) {
      maker.hold_long_faces();
    }
    for (; next < header_.elements.size(); ++next) {
      const PlyElement& element = header_.elements[next];
      has_corners(element) ? body->read_corners(element, maker) : body->skip(element);
    }
    small_faces_ = maker.small_faces();
    if (maker.guessed_faces() > 0) warn(maker.guess_warning(file_.path()));
    warn(body->take_oddity());
    if (!body->at_end()) {
      warn(file_.path().string() + ": there is more in the file than its header says");
    }
  }

 private:
  using Keep = VertexStore::Keep;

  /// A body that stands before an element.
  struct Parked {
    std::unique_ptr<PlyBody> body;
    std::size_t next = 0;
  };

  /// Reads all vertices. Returns what follows them.
  Parked read_vertices(const std::function<void(std::span<const Vec3>)>& take, Keep keep) {
    std::unique_ptr<PlyBody> body = open_body();
    std::size_t next = 0;
    while (header_.elements[next].role != PlyRole::vertices) body->skip(header_.elements[next++]);
    const PlyElement& vertices = header_.elements[next++];
    store_.fill({info_.positions, vertices.count, keep}, take, [&](const VertexStore::Take& pass) {
      Batch<Vec3> batch(pass);
      body->read_vertices(vertices, batch);
      return !body->has_lost_digits();
    });
    warn(body->take_oddity());
    if (body->has_lost_digits()) read_as_doubles();  // from the next scan on
    return {std::move(body), next};
  }

  void read_as_doubles() {
    floats_ = AsciiFloats::as_doubles;
    info_.positions = PositionType::float64;
  }

  /// Whether the first vertices show it already: then not all of them are read twice.
  bool has_more_digits_than_floats() const {
    constexpr std::uint64_t k_few = 1024;
    if (header_.format != PlyFormat::ascii || info_.positions != PositionType::float32)
      return false;
    const PlyElement& first = header_.elements.front();
    if (first.role != PlyRole::vertices) return false;
    PlyElement few = first;
    few.count = std::min(few.count, k_few);
    const std::unique_ptr<PlyBody> body = open_body(1);
    const Batch<Vec3>::Take nothing = [](std::span<const Vec3>) {};
    Batch<Vec3> batch(nothing);
    try {
      body->read_vertices(few, batch);
    } catch (const DataError&) {
      return false;  // the scan that is asked for tells what is wrong
    }
    return body->has_lost_digits();
  }

  /// Of polygons alone is this asked. By whatever way is there, or else by another scan.
  Vec3 position_of(std::uint64_t vertex) {
    if (store_.is_filled()) return store_.at(vertex);
    if (!positions_) positions_ = PlyPositions::in_file(file_, header_);
    if (positions_) return positions_->at(vertex);
    read_vertices([](std::span<const Vec3>) {}, Keep::always);
    return position_of(vertex);  // a second scan, should digits have been lost
  }

  static bool has_corners(const PlyElement& element) {
    return element.role == PlyRole::faces || element.role == PlyRole::strips;
  }

  /// To parse or to decompress again takes longer than all else that a scan is for.
  bool is_worth_keeping() const {
    const bool is_slow =
        header_.format == PlyFormat::ascii || file_.compression() != Compression::none;
    return is_slow && options_.scans == Scans::many;
  }

  void fill_info() {
    info_.format = header_.title.empty() ? name_of(header_.format) : header_.title;
    info_.compression = name_of(file_.compression());
    info_.vertices = header_.vertices().count;
    info_.positions = position_type(header_.vertices());
    if (options_.channels) channels_ = channels_of(header_.vertices());
    for (const PlyChannel& each : channels_) info_.channels.push_back(each.channel);
    if (options_.labels) find_labels();
    info_.skipped = skipped_names(header_, channels_);
    for (const PlyElement& element : header_.elements) {
      if (has_corners(element)) info_.faces += element.count;
    }
  }

  /// Strips have none, and all triangles or none have labels.
  void find_labels() {
    PlyElement* faces = nullptr;
    for (PlyElement& element : header_.elements) {
      if (!has_corners(element) || element.count == 0) continue;
      if (element.role == PlyRole::strips) return;
      faces = &element;
    }
    if (faces == nullptr || !(faces->label = label_of(*faces))) return;
    info_.labels = LabelMeaning{faces->properties[*faces->label].name, {}};
  }

  /// A file is scanned more than once, but each warning about it is given once.
  void warn(const std::string& line) {
    if (!line.empty() && warnings_.insert(line).second) log_warning(line);
  }

  std::unique_ptr<PlyBody> open_body() const { return open_body(options_.threads); }
  std::unique_ptr<PlyBody> open_body(unsigned threads) const {
    std::unique_ptr<ByteStream> stream = file_.open();
    stream->skip(header_.size_bytes);
    return header_.format == PlyFormat::ascii
               ? make_ascii_body(std::move(stream), file_.path(), header_,
                                 {floats_, threads, header_.has_comments})
               : make_binary_body(std::move(stream), file_.path(), header_);
  }

  InputFile file_;
  OpenOptions options_;
  PlyHeader header_;
  std::vector<PlyChannel> channels_;
  VertexStore store_;
  AsciiFloats floats_ = AsciiFloats::as_floats;
  std::unique_ptr<PlyPositions> positions_;
  Parked parked_;
  MeshFileInfo info_;
  std::uint64_t small_faces_ = 0;
  std::set<std::string> warnings_;
};

}  // namespace

bool is_ply_file(const InputFile& file) {
  return is_ply(file.open()->window(ByteStream::k_max_window_bytes));
}

std::unique_ptr<MeshSource> open_ply(InputFile file, const OpenOptions& options) {
  return std::make_unique<PlySource>(std::move(file), options, parse_ply_header);
}

bool is_off_file(const InputFile& file) {
  return is_off(file.open()->window(ByteStream::k_max_window_bytes));
}

std::unique_ptr<MeshSource> open_off(InputFile file, const OpenOptions& options) {
  return std::make_unique<PlySource>(std::move(file), options, parse_off_header);
}

}  // namespace meshfarm
