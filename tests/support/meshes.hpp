// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

/// Small meshes for tests. Closed ones are oriented outwards.
namespace meshfarm::test {

/// Four vertices, four triangles; one corner at the origin, legs of length 1.
Mesh tetrahedron();

/// A closed octahedron of radius 1.
Mesh octahedron();

/// A closed box of these sizes, with twelve triangles; opposite faces have the same diagonals.
Mesh box(Vec3 size);

/// An icosahedron, each triangle split into four `levels` times, on the sphere of radius 1:
/// 20 * 4^levels triangles, 10 * 4^levels + 2 vertices.
Mesh icosphere(int levels);

/// A closed torus round the z axis, radii 1 and 0.4: `rows` rings of `columns` vertices each
/// (both at least 3), 2 * rows * columns triangles.
Mesh torus(std::uint32_t rows, std::uint32_t columns);

/// The torus with its first ring contracted to a neck of no width: twice as many triangles as there
/// are columns have two corners at one place.
Mesh torus_with_neck(std::uint32_t rows, std::uint32_t columns);

void append(Mesh& mesh, const Mesh& other);

/// A torus with every third ring contracted to a point: its necks have no width.
Mesh torus_with_necks(std::uint32_t rows, std::uint32_t columns);

/// A row of octahedra; each touches the next at a tip, or along an edge.
Mesh touching_row(std::uint32_t count, bool at_edges);

/// The mesh, and a triangle of its first two vertices and one that is `far` times its size away.
Mesh with_outlier(Mesh mesh, double far);

/// The mesh, and `many` triangles, each of an edge of the mesh and a vertex of its own; all of
/// these vertices lie at one point of the mesh.
Mesh with_crowd(Mesh mesh, std::uint32_t many);

/// The mesh with vertices without a position inserted between its own; `triangles` triangles use
/// some of them, no triangle uses the others.
Mesh with_lost_vertices(const Mesh& mesh, std::uint32_t triangles);

/// The same triangles, each with three vertices of its own: its corners, each coordinate moved by
/// up to `by`.
Mesh jittered_soup(const Mesh& mesh, double by);

/// A mesh and its reflection in a point of its surface, where the two touch.
Mesh touching_twice(const Mesh& mesh, Vec3 point);

/// One for each of `count` vertices, all different.
std::vector<Appearance> appearances(std::size_t count);

/// A flat open sheet of nx x ny unit squares in z = 0, seen from +z:
///
///     6---7---8
///     | / | / |      grid(2, 2): vertex y * (nx + 1) + x,
///     3---4---5      2 * nx * ny triangles,
///     | / | / |      2 * (nx + ny) border edges
///     0---1---2
Mesh grid(std::uint32_t nx, std::uint32_t ny);

/// Two triangles that share one vertex, which is not manifold:
///
///     1       4
///     | \   / |
///     |   0   |
///     | /   \ |
///     2       3
Mesh bow_tie();

/// Three triangles at one edge 0-1, which is not manifold, seen from its end:
///
///        2
///        |
///       0,1
///      /   \        .
///     3     4
Mesh three_fans();

}  // namespace meshfarm::test
