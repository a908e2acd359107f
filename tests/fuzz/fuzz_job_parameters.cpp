// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/pipeline/bake_job.hpp>
#include <meshfarm/pipeline/compose_job.hpp>
#include <meshfarm/pipeline/cut_job.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>
#include <meshfarm/pipeline/sort_job.hpp>
#include <meshfarm/pipeline/sweep_job.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/bundle_list.hpp"

namespace {

template <class Decode>
void try_to(Decode decode, std::string_view bytes) {
  try {
    decode(bytes);
  } catch (const meshfarm::DataError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try_to(decode_parameters, bytes);
  try_to(decode_sweep_parameters, bytes);
  try_to(decode_compose_parameters, bytes);
  try_to(decode_sort_parameters, bytes);
  try_to(decode_tile_parameters, bytes);
  try_to(decode_bake_parameters, bytes);
  try_to(decode_cut_parameters, bytes);
  try_to(decode_join_parameters, bytes);
  try_to([](std::string_view summary) { decode_survey(summary, "summary"); }, bytes);
  try_to([](std::string_view summary) { decode_partition_summary(summary, "summary"); }, bytes);
  try_to([](std::string_view summary) { decode_join_summary(summary, "summary"); }, bytes);
  try_to([](std::string_view summary) { decode_vertex_bundle(summary, "summary"); }, bytes);
  try_to([](std::string_view summary) { decode_triangle_bundle(summary, "summary"); }, bytes);
  try_to([](std::string_view summary) { decode_finish_summary(summary, "summary"); }, bytes);
  try_to([](std::string_view summary) { decode_tile_summary(summary, "summary"); }, bytes);
  try_to([](std::string_view summary) { decode_sort_summary(summary, "summary"); }, bytes);
  return 0;
}
