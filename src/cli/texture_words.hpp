// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

inline constexpr const char* k_uv_words = "auto|keep|bake|colours|drop";
inline constexpr const char* k_uv_help =
    "textures: keep: keep their charts and pictures; bake: make a new picture; colours: turn them "
    "into vertex colours; drop: leave them out; auto: keep if the number of triangles can be met "
    "that way, else bake, or colours if the output format cannot store textures";

/// --uv of commands that read a mesh: how to use its textures. Throws UsageError.
Textures parse_uv(const std::string& text);

/// --uv of commands that take a stage. Throws UsageError.
TextureMode parse_texture_mode(const std::string& text);

/// --uv when a mesh is cut and the result written by one command.
struct TextureWords {
  std::string cut;  // for parse_uv()
  std::string run;  // for parse_texture_mode()
};
/// Depends on what the output can store. Throws UsageError for textures that it cannot store.
TextureWords texture_words_for(const std::string& output, const std::string& uv);
/// The same for a run of an existing stage.
std::string stage_uv_for(const std::string& output, const std::string& uv);

/// Reports, before the work, what happens to the stage's textures, if that differs from the request
/// or was not requested.
void tell_textures(const Manifest& manifest, const RunOptions& run);

}  // namespace meshfarm
