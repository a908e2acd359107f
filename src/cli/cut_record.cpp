// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The record of a cut is sealed (staging/sealed.hpp), kind "CUTR", version 1:
//   size u64 | changed i64 | checksum of head and tail u64 | options text     text = length u32 |
//   bytes
#include "cli/cut_record.hpp"

#include <algorithm>
#include <array>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

#include <meshfarm/pipeline/algorithm.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "cli/texture_words.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_kind = {'C', 'U', 'T', 'R'};
constexpr std::uint32_t k_cut_record_version = 1;
constexpr std::uint64_t k_end_bytes = std::uint64_t{1} << 20;

/// What the stage contains of the textures, whatever a run makes of it.
const char* word_of(Textures textures) {
  if (textures == Textures::bake) return "colours";
  return textures == Textures::keep ? "keep" : "drop";
}

/// Threads are left out: they do not change the output.
std::string options_of(const CutWords& words, bool farmed) {
  std::string text = "--scheme " + words.scheme_word + " --weld " + words.weld + " --parts " +
                     std::to_string(words.cut.parts);
  if (words.cut.scheme == Scheme::stream) {
    text += " --sort " + words.sort + " --window " + std::to_string(words.cut.window_triangles) +
            " --memory " + std::to_string(words.cut.sort_memory());
  }
  if (farmed) text += " --cut farm";
  if (words.attributes != "auto") text += " --attributes " + words.attributes;
  text += std::string(" --uv ") + word_of(parse_uv(words.uv));
  return text + ", algorithm " + std::to_string(k_algorithm_version);
}

/// The record without options.
CutRecord record_of(const std::string& input) {
  const Fd fd = open_for_read(input);
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) throw_errno("cannot look at", input);
  CutRecord record;
  record.size = static_cast<std::uint64_t>(status.st_size);
  record.changed_ns = std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
  Checksum sum;
  std::string piece(std::min(record.size, k_end_bytes), '\0');
  for (const std::uint64_t at : {std::uint64_t{0}, record.size - piece.size()}) {
    if (::lseek(fd.get(), static_cast<off_t>(at), SEEK_SET) < 0) throw_errno("cannot read", input);
    piece.resize(read_up_to(fd.get(), piece, input));
    sum.add(piece);
  }
  record.sum = sum.value();
  return record;
}

}  // namespace

CutRecord record_of(const std::string& input, const CutWords& words, bool farmed) {
  CutRecord record = record_of(input);
  record.options = options_of(words, farmed);
  return record;
}

bool holds_cut(const std::filesystem::path& stage) {
  std::error_code ignored;
  return std::filesystem::exists(stage / to_string(ManifestName{}), ignored);
}

bool is_of_input(const Stage& stage, const std::string& file) {
  const std::optional<CutRecord> staged = read_record(stage);
  if (!staged) return false;
  const CutRecord now = record_of(file);
  return now.size == staged->size && now.changed_ns == staged->changed_ns && now.sum == staged->sum;
}

std::string difference(const CutRecord& staged, const CutRecord& wanted) {
  if (staged.size != wanted.size) {
    return "another input: it had " + std::to_string(staged.size) + " bytes, now it has " +
           std::to_string(wanted.size);
  }
  if (staged.sum != wanted.sum) return "another input: of the same size, but other content";
  if (staged.changed_ns != wanted.changed_ns) return "an input that was written anew since";
  if (staged.options != wanted.options) {
    return "other options: it was cut with " + staged.options + ", not " + wanted.options;
  }
  return {};
}

void publish_record(const Stage& stage, const CutRecord& record) {
  ByteWriter out;
  out.put(record.size);
  out.put(record.changed_ns);
  out.put(record.sum);
  out.put_string(record.options);
  stage.publish(CutName{}, seal(k_kind, k_cut_record_version, out.bytes()));
}

std::optional<CutRecord> read_record(const Stage& stage) {
  std::error_code ignored;
  if (!std::filesystem::exists(stage.path(CutName{}), ignored)) return std::nullopt;
  const std::string what = stage.path(CutName{}).string();
  const std::string file = stage.read(CutName{});
  ByteReader in(unseal(file, k_kind, k_cut_record_version, what), what);
  CutRecord record;
  record.size = in.get<std::uint64_t>();
  record.changed_ns = in.get<std::int64_t>();
  record.sum = in.get<std::uint64_t>();
  record.options = in.get_string();
  in.expect_end();
  return record;
}

}  // namespace meshfarm
