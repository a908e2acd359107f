// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <sstream>
#include <utility>

#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/render/render.hpp>
#include <meshfarm/util/log.hpp>

#include "cli/command.hpp"
#include "cli/cut_step.hpp"
#include "cli/measure_words.hpp"
#include "cli/options.hpp"
#include "cli/output_place.hpp"
#include "cli/staged_picture.hpp"
#include "cli/view_words.hpp"

namespace meshfarm {
namespace {

class RenderCommand : public Command {
 public:
  std::string_view name() const override { return "render"; }
  std::string_view synopsis() const override { return "MESH|STAGE -o PICTURE.png"; }
  std::string_view summary() const override {
    return "draw a picture of a mesh of any size, in bounded memory";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("mesh", po::value(&mesh_)->required(), "");
    view_.add(options);
    measure_.add(options);
    talk_.add_quiet(options);
    positional.add("mesh", 1);
  }
  void check() override {
    view_.check();
    measure_.check();
    view_.render.memory_bytes = measure_.divide.memory_bytes;
    view_.render.folder = measure_.divide.folder;
    view_.render.threads = measure_.divide.threads;
  }
  int run() override {
    check_place(view_.output);
    check_not_over("-o", view_.output, "the input", mesh_);
    check_not_of_stage("-o", view_.output, mesh_);
    if (talk_.quiet) set_log(name(), LogLevel::warning);
    ProgressPrinter printer(talk_.progress());
    RenderOptions& options = view_.render;
    options.name = mesh_;
    options.progress = [&](std::string_view phase, double done) {
      printer.show({.phase = phase, .done = done});
    };
    Rendering made =
        std::filesystem::is_directory(mesh_) ? render_stage(mesh_, options) : render(options);
    printer.end();
    write_png(view_.output, std::move(made.picture));
    tell(made);
    return 0;
  }

 private:
  Rendering render(const RenderOptions& options) const {
    const auto source = open_mesh(mesh_, {.threads = options.threads,
                                          .textures = textures_for(options),
                                          .picture_bytes = options.memory_bytes / 2});
    tell_textures(mesh_, source->info());
    return render_mesh(*source, options);
  }

  void tell(const Rendering& made) const {
    std::string line = view_.output + ": " + std::to_string(made.triangles) + " triangles";
    if (!made.colours.empty()) line += ", coloured by " + made.colours;
    if (made.range) {
      std::ostringstream range;
      range << " from " << (*made.range)[0] << " to " << (*made.range)[1];
      line += range.str();
    }
    if (made.pieces > 0) line += " (" + std::to_string(made.pieces) + ")";
    log_info(line);
    if (made.not_finite > 0) {
      log_warning(mesh_ + ": left out: " + std::to_string(made.not_finite) +
                  " triangles with positions that are not finite");
    }
  }

  std::string mesh_;
  ViewWords view_;
  MeasureWords measure_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_render_command() {
  return std::make_unique<RenderCommand>();
}

}  // namespace meshfarm
