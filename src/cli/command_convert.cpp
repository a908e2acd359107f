// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <vector>

#include <meshfarm/io/convert_mesh.hpp>
#include <meshfarm/io/map_names.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/text.hpp>

#include "cli/command.hpp"
#include "cli/cut_step.hpp"
#include "cli/options.hpp"
#include "cli/output_place.hpp"
#include "cli/output_words.hpp"
#include "cli/texture_words.hpp"

namespace meshfarm {
namespace {

class ConvertCommand : public Command {
 public:
  std::string_view name() const override { return "convert"; }
  std::string_view synopsis() const override { return "INPUT OUTPUT"; }
  std::string_view summary() const override {
    return "write a mesh in another format, streamed, nothing simplified";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("input", po::value(&input_)->required(), "")(
        "output", po::value(&output_)->required(), "")(
        "threads", po::value(&threads_)->default_value(threads_)->value_name("N"),
        "threads that parse text (0: one a core)")(
        "uv", po::value(&uv_)->default_value(uv_)->value_name("auto|keep|colours|drop"),
        "textures: keep: keep their coordinates, and pictures beside the output or in it; colours: "
        "turn them into vertex colours; drop: leave them out; auto: keep, or colours if the output "
        "format can store only those");
    output_words_.add(options);
    talk_.add_quiet(options);
    positional.add("input", 1).add("output", 1);
  }
  void check() override {
    if (uv_ == "bake") {
      throw UsageError("--uv bake needs a stage: use 'simplify' or 'run'");
    }
    if (is_output_format(output_)) texture_words_for(output_, uv_);
  }
  void check_given(const GivenOptions& given) const override {
    output_words_.check_given(given, output_);
  }
  int run() override {
    check_not_over("OUTPUT", output_, "the input", input_);
    check_writable(output_);
    if (talk_.quiet) set_log(name(), LogLevel::warning);
    const Textures textures = parse_uv(texture_words_for(output_, uv_).cut);
    const auto source = open_mesh(
        input_, {.threads = threads_, .labels = keeps_labels(output_), .textures = textures});
    if (textures == Textures::bake) tell_textures(input_, source->info());
    ProgressPrinter printer(talk_.progress());
    const Converted made = convert_mesh(
        *source, output_, [&](double done) { printer.show({.phase = "convert", .done = done}); },
        output_words_.packing());
    printer.end();
    tell_what_is_left_out(made, source->info());
    return 0;
  }

 private:
  void tell_what_is_left_out(const Converted& made, const MeshFileInfo& input) const {
    std::vector<std::string> names;
    for (const Channel& channel : input.channels) {
      const bool is_kept =
          std::find(made.channels.begin(), made.channels.end(), channel) != made.channels.end();
      if (!is_kept) names.push_back("vertex." + channel.name);
    }
    if (made.has_labels && !input.labels->materials.empty() && !keeps_materials(output_)) {
      names.push_back("names and colours of " + input.labels->name + "s");
    }
    add_maps_left_out(input, names);
    names.insert(names.end(), input.skipped.begin(), input.skipped.end());
    if (!names.empty()) log_info(input_ + ": not kept: " + joined(names));
    if (made.small_faces > 0) {
      log_warning(input_ + ": left out: " + std::to_string(made.small_faces) +
                  " faces of 0 to 2 corners");
    }
    if (made.dropped_not_finite > 0) {
      log_warning(input_ + ": left out: " + std::to_string(made.dropped_not_finite) +
                  " triangles with positions that are not finite");
    }
  }

  /// Adds kinds of pictures that materials have but the output cannot store.
  void add_maps_left_out(const MeshFileInfo& input, std::vector<std::string>& names) const {
    if (!input.uvs || !input.labels) return;
    const std::vector<std::string> maps =
        maps_left_out(*input.labels, [this](MapUse use) { return keeps_map(output_, use); });
    names.insert(names.end(), maps.begin(), maps.end());
  }

  std::string input_;
  std::string output_;
  std::string uv_ = "auto";
  unsigned threads_ = 0;
  OutputWords output_words_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_convert_command() {
  return std::make_unique<ConvertCommand>();
}

}  // namespace meshfarm
