// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <boost/program_options.hpp>

#include <meshfarm/render/render.hpp>

namespace meshfarm {

namespace po = boost::program_options;

/// Options of a picture: --output, --view, --up, --projection, --size, --samples, --colour-by,
/// --range, --wire, --background.
struct ViewWords {
  RenderOptions render;
  std::string output;

  void add(po::options_description& options);
  void check();

 private:
  std::string view_ = "iso";
  std::string up_ = "y";
  std::string projection_ = "perspective";
  std::string size_ = "1600x1200";
  std::string colour_by_ = "auto";
  std::string range_;
  std::string background_ = "white";
};

/// "x" to "-z" as a direction. Throws UsageError naming --up.
Vec3 parse_up(const std::string& word);

}  // namespace meshfarm
