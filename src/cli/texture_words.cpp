// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/texture_words.hpp"

#include <filesystem>
#include <vector>

#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/text.hpp>

namespace meshfarm {
namespace {

bool keeps_colours(const std::filesystem::path& output) {
  const std::vector<Channel> colour{{"red", ChannelType::uint8, ChannelRole::colour},
                                    {"green", ChannelType::uint8, ChannelRole::colour},
                                    {"blue", ChannelType::uint8, ChannelRole::colour}};
  return !kept_channels(output, colour).empty();
}

}  // namespace

Textures parse_uv(const std::string& text) {
  if (text == "colours") return Textures::bake;
  if (text == "drop") return Textures::drop;
  if (text == "auto" || text == "keep" || text == "bake") return Textures::keep;
  throw UsageError("--uv is 'auto', 'keep', 'bake', 'colours' or 'drop', not '" + text + "'");
}

TextureMode parse_texture_mode(const std::string& text) {
  if (text == "auto") return TextureMode::automatic;
  if (text == "keep") return TextureMode::keep;
  if (text == "bake") return TextureMode::bake;
  if (text == "drop") return TextureMode::drop;
  throw UsageError("--uv of a stage is 'auto', 'keep', 'bake' or 'drop', not '" + text + "'");
}

TextureWords texture_words_for(const std::string& output, const std::string& uv) {
  const Textures wanted = parse_uv(uv);
  if (wanted == Textures::drop) return {"drop", "drop"};
  if (wanted == Textures::keep && keeps_uvs(output)) return {uv, uv};
  if (uv == "keep") {
    throw UsageError("--uv keep: " + output +
                     " has no place for textures; --uv colours, or another format");
  }
  // What the output cannot store need not be made.
  return {keeps_colours(output) ? "colours" : "drop", "drop"};
}

std::string stage_uv_for(const std::string& output, const std::string& uv) {
  parse_texture_mode(uv);
  return is_output_format(output) ? texture_words_for(output, uv).run : uv;
}

void tell_textures(const Manifest& manifest, const RunOptions& run) {
  if (!manifest.uvs) return;
  const std::uint64_t floor = texture_floor(manifest);
  const std::uint64_t target = asked_triangles(manifest, run);
  const std::string needed =
      "keeping the charts of its textures needs about " + std::to_string(floor) + " triangles";
  const TextureMode made = chosen_textures(manifest, run);
  if (made == TextureMode::keep && floor > target && !(run.error.value > 0)) {
    log_warning(manifest.input + ": " + needed + ", " + std::to_string(target) +
                " are asked for; --uv bake meets the requested number");
  } else if (made == TextureMode::drop && chooses_uvs(run.channels) &&
             run.textures != TextureMode::drop) {
    log_warning(manifest.input + ": its texture coordinates are left out: " + needed +
                ", and it has no pictures to make a new one of");
  } else if (made == TextureMode::bake && run.textures == TextureMode::automatic) {
    log_info(manifest.input + ": a new texture is made: " + needed);
  }
}

}  // namespace meshfarm
