// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <meshfarm/io/convert_mesh.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/text.hpp>

#include "cli/command.hpp"
#include "cli/cut_step.hpp"
#include "cli/options.hpp"
#include "cli/output_words.hpp"
#include "cli/texture_words.hpp"

namespace meshfarm {
namespace {

const std::vector<Channel> k_colour{{"red", ChannelType::uint8, ChannelRole::colour},
                                    {"green", ChannelType::uint8, ChannelRole::colour},
                                    {"blue", ChannelType::uint8, ChannelRole::colour}};

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
        "that parse text (0: one a core)")(
        "uv", po::value(&uv_)->default_value(uv_)->value_name("bake|drop"), k_uv_help);
    output_words_.add(options);
    talk_.add_quiet(options);
    positional.add("input", 1).add("output", 1);
  }
  void check() override { parse_uv(uv_); }
  int run() override {
    check_writable(output_);
    if (talk_.quiet) set_log(name(), LogLevel::warning);
    // What the output has no place for need not be made.
    const bool has_place = !kept_channels(output_, k_colour).empty();
    const auto source = open_mesh(input_, {.threads = threads_,
                                           .labels = keeps_labels(output_),
                                           .textures = has_place ? parse_uv(uv_) : Textures::drop});
    tell_textures(input_, source->info());
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

  std::string input_;
  std::string output_;
  std::string uv_ = "bake";
  unsigned threads_ = 0;
  OutputWords output_words_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_convert_command() {
  return std::make_unique<ConvertCommand>();
}

}  // namespace meshfarm
