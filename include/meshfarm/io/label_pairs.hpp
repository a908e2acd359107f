// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/labels.hpp>

namespace meshfarm {

/// The labels of a mesh's triangles and what they say.
struct MeantLabels {
  const LabelMeaning& meaning;
  std::vector<Label> labels;
};

/// Writes numbers for the labels of two meshes so that the same numbers are the same labels. Those
/// that both have names are the same if their names are, whatever stands for blanks in them. A
/// number has the name that it gets where it becomes a material; where the other mesh has no such
/// name, numbers are compared as they are.
void pair_labels(MeantLabels& a, MeantLabels& b);

}  // namespace meshfarm
