// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <array>
#include <cstdint>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>
#include <vtkVersion.h>

#include "peer.hpp"

namespace meshfarm::bench {
namespace {

void fill(vtkPolyData& out, const Mesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.positions.size()));
  vtkIdType vertex = 0;
  for (const Vec3& p : mesh.positions) points->SetPoint(vertex++, p.x, p.y, p.z);
  vtkNew<vtkCellArray> cells;
  cells->AllocateExact(static_cast<vtkIdType>(mesh.triangles.size()),
                       static_cast<vtkIdType>(3 * mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    const std::array<vtkIdType, 3> corners{t[0], t[1], t[2]};
    cells->InsertNextCell(3, corners.data());
  }
  out.SetPoints(points);
  out.SetPolys(cells);
  if (mesh.appearances.empty()) return;
  vtkNew<vtkFloatArray> colours;
  colours->SetNumberOfComponents(3);
  for (const Appearance& appearance : mesh.appearances) {
    colours->InsertNextTypedTuple(colour_of(appearance).data());
  }
  out.GetPointData()->SetScalars(colours);
}

Mesh from_vtk(vtkPolyData& in) {
  Mesh out;
  for (vtkIdType v = 0; v < in.GetNumberOfPoints(); ++v) {
    std::array<double, 3> p{};
    in.GetPoint(v, p.data());
    out.positions.push_back({p[0], p[1], p[2]});
  }
  if (auto* const colours = vtkFloatArray::SafeDownCast(in.GetPointData()->GetScalars())) {
    for (vtkIdType v = 0; v < in.GetNumberOfPoints(); ++v) {
      std::array<float, 3> colour{};
      colours->GetTypedTuple(v, colour.data());
      out.appearances.push_back(appearance_of(colour));
    }
  }
  vtkCellArray* cells = in.GetPolys();
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c) {
    vtkIdType corners = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCellAtId(c, corners, ids);
    Triangle t{};
    for (std::size_t i = 0; i < 3; ++i) t[i] = static_cast<std::uint32_t>(ids[i]);
    out.triangles.push_back(t);
  }
  return out;
}

Mesh simplify(Task task, Stopwatch& watch) {
  vtkNew<vtkPolyData> mesh;
  fill(*mesh, task.mesh);
  const double before = static_cast<double>(task.mesh.triangles.size());
  const bool coloured = !task.mesh.appearances.empty();
  task.mesh = {};
  vtkNew<vtkQuadricDecimation> decimation;
  // Scalars with their default weight, no other attributes.
  decimation->SetAttributeErrorMetric(coloured);
  decimation->SetInputData(mesh);
  decimation->SetTargetReduction(1 - static_cast<double>(task.target) / before);
  watch.start();
  decimation->Update();
  watch.stop();
  return from_vtk(*decimation->GetOutput());
}

}  // namespace
}  // namespace meshfarm::bench

int main(int argc, char** argv) {
  using namespace meshfarm::bench;
  return run_peer(argc, argv, {"VTK quadric", vtkVersion::GetVTKVersion(), simplify});
}
