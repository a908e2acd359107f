// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/cut_step.hpp"

#include <filesystem>

#include <unistd.h>

#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/partition/cut.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/stream/generate_streams.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {

Manifest cut_to_stage(const CutStep& step) {
  const auto source = open_mesh(step.input);
  const Stage stage = Stage::create(step.stage);
  if (stage.has_manifest()) {
    throw DataError(step.stage + ": holds a finished cut; 'meshfarm replay " + step.stage +
                    "' uses it, or remove it to cut again");
  }
  ProgressPrinter printer(step.talk.progress());
  const auto with_common = [&](auto options) {
    options.input_name = step.input;
    options.stop = &step.stop;
    options.progress = [&](std::string_view phase, double done) {
      printer.show({.phase = phase, .done = done, .triangles = 0});
    };
    return options;
  };
  if (step.words.scheme == Scheme::stream) {
    return generate_streams(*source, stage, with_common(step.words.stream));
  }
  return cut_mesh(*source, stage, with_common(step.words.cut));
}

void check_writable(const std::string& output) {
  const std::filesystem::path path(output);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (std::filesystem::is_directory(path))
    throw IoError("cannot write over the folder", path, EISDIR);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) throw_errno("cannot write into", folder);
}

}  // namespace meshfarm
