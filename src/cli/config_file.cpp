// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/config_file.hpp"

#include <cctype>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// Some editors begin UTF-8 with it.
constexpr std::string_view k_utf8_mark = "\xEF\xBB\xBF";

bool is_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-';
}

bool begins_section(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string::npos && line[first] == '[';
}

}  // namespace

/// Parses line by line, since the parser does not report where it stopped.
ConfigFile::ConfigFile(const std::string& path, const po::options_description& options)
    : path_(path), parsed_(&options) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw IoError("cannot read", path, EISDIR);
  std::ifstream text(path);  // or a pipe
  if (!text) throw_errno("cannot open", path);
  std::size_t number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    if (number == 1 && line.starts_with(k_utf8_mark)) line.erase(0, k_utf8_mark.size());
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (begins_section(line)) throw UsageError(place_of_line(number) + "there are no sections");
    std::istringstream one(line);
    try {
      for (auto& option : po::parse_config_file(one, options).options) {
        lines_.emplace(option.string_key, number);
        parsed_.options.push_back(std::move(option));
      }
    } catch (const po::invalid_config_file_syntax&) {
      throw UsageError(place_of_line(number) + "no NAME = VALUE: '" + line + "'");
    } catch (const po::error& error) {
      throw UsageError(place_of_line(number) + error.what());
    }
  }
  if (text.bad()) throw_errno("cannot read", path);
}

void ConfigFile::store(po::variables_map& values) const {
  if (lines_.empty()) return;
  try {
    po::store(parsed_, values);
  } catch (const po::error_with_option_name& error) {
    const auto line = lines_.find(error.get_option_name());
    const std::string place =
        line != lines_.end() ? place_of_line(line->second) : std::string(path_ + ": ");
    throw UsageError(place + error.what());
  }
}

std::string ConfigFile::placed(const std::string& error, const GivenOptions& given) const {
  constexpr std::string_view k_dashes = "--";
  for (std::size_t at = error.find(k_dashes); at != std::string::npos;
       at = error.find(k_dashes, at)) {
    at += k_dashes.size();
    std::size_t end = at;
    while (end < error.size() && is_of_name(error[end])) ++end;
    const std::string_view name = std::string_view(error).substr(at, end - at);
    const auto line = lines_.find(name);
    if (line != lines_.end() && !given.contains(name)) return place_of_line(line->second) + error;
  }
  return error;
}

std::string ConfigFile::place_of_line(std::size_t number) const {
  return path_ + ": line " + std::to_string(number) + ": ";
}

}  // namespace meshfarm
