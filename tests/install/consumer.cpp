// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <iostream>

#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/io/ply_writer.hpp>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto source = meshfarm::open_mesh(argv[1]);
  meshfarm::Simplifier simplifier(meshfarm::read_mesh(*source),
                                  {.positions = source->info().positions});
  simplifier.reduce({.triangles = 1000});
  meshfarm::write_ply(argv[2], simplifier.mesh(), source->info().positions);
  std::cout << simplifier.triangles() << "\n";
}
