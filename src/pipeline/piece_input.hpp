// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// The input's surface that a piece is made of: a range of parts, and the triangles between them.
/// Where parts are not kept, each is built anew whenever it is shown. One is in memory at a time.
class PieceInput {
 public:
  using Show = std::function<void(const Mesh&)>;

  /// Both must outlive this. Throws DataError if there are no such parts.
  PieceInput(const Stage& stage, const MeasureParameters& parameters);

  /// Parts whose boxes are wanted; at first all. Then what lies between them.
  void show(const std::function<bool(const Box&)>& wants, const Show& show_part,
            const Show& show_between);

 private:
  Part read_part(std::uint32_t part) const;
  Mesh between() const;

  const Stage& stage_;
  const MeasureParameters& parameters_;
  Manifest manifest_;  // if parts are kept
  std::uint32_t first_;
  std::uint32_t end_;
  std::vector<Box> boxes_;
  std::vector<std::vector<Vec3>> boundary_;
};

}  // namespace meshfarm
