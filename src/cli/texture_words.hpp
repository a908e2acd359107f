// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

inline constexpr const char* k_uv_words = "auto|keep|bake|colours|drop";
inline constexpr const char* k_uv_help =
    "textures: keep: their charts and pictures stay; bake: a new picture is made; colours: theirs "
    "become those of the vertices; drop: they are left out; auto: keep if the number of triangles "
    "can be met so, else bake, or colours where the output has no place for textures";

/// --uv of commands that read a mesh: what they make of its textures. Throws UsageError.
Textures parse_uv(const std::string& text);

/// --uv of commands that take a stage. Throws UsageError.
TextureMode parse_texture_mode(const std::string& text);

/// --uv where a mesh is cut and the result written at once.
struct TextureWords {
  std::string cut;  // as parse_uv() takes it
  std::string run;  // as parse_texture_mode() does
};
/// What has a place in the output decides. Throws UsageError for textures that have none.
TextureWords texture_words_for(const std::string& output, const std::string& uv);
/// The same for a run of a stage that was cut before.
std::string stage_uv_for(const std::string& output, const std::string& uv);

/// Tells, before the work, what becomes of the stage's textures, where that is not as asked, or was
/// not asked for.
void tell_textures(const Manifest& manifest, const RunOptions& run);

}  // namespace meshfarm
