// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/labels.hpp>

namespace meshfarm {

/// The labels of a mesh's triangles and their meaning.
struct MeantLabels {
  const LabelMeaning& meaning;
  std::vector<Label> labels;
};

/// Renumbers the labels of two meshes so that equal numbers mean equal labels. If both have names,
/// labels are equal if their names are, whatever replaces blanks in them. A label that is only a
/// number has the name that it gets as a material; where the other mesh has no such name, numbers
/// are compared as they are.
void pair_labels(MeantLabels& a, MeantLabels& b);

}  // namespace meshfarm
