// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include <meshfarm/geometry/generate.hpp>

namespace meshfarm {

// One file each: generate_foam.cpp and so on. The size was checked before.
std::unique_ptr<GeneratedMesh> make_foam(std::uint64_t triangles);
std::unique_ptr<GeneratedMesh> make_dust(std::uint64_t triangles);
std::unique_ptr<GeneratedMesh> make_soup(std::uint64_t triangles);
std::unique_ptr<GeneratedMesh> make_terrain(std::uint64_t triangles);
std::unique_ptr<GeneratedMesh> make_block(std::uint64_t triangles);
std::unique_ptr<GeneratedMesh> make_shell(std::uint64_t triangles);

}  // namespace meshfarm
