// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/manual.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>

#include <meshfarm/util/errors.hpp>

#include "cli/version.hpp"

namespace meshfarm {
namespace {

/// Text as man roff: hyphens stay copyable, and no line starts with a request.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) {
      out += std::string("\\&") + c;
    } else {
      out += c;
    }
  }
  return out;
}

std::string upper(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return out;
}

std::string page_head(std::string_view name, std::string_view summary) {
  std::ostringstream out;
  out << ".TH " << upper(roff(name)) << R"( 1 "" "meshfarm )" << k_version
      << R"(" "User Commands")"
         "\n.SH NAME\n"
      << roff(name) << " \\- " << roff(summary) << "\n";
  return out.str();
}

std::string page_foot(std::string_view see_also) {
  std::ostringstream out;
  out << ".SH EXIT STATUS\n";
  for (const ExitCode& exit : exit_codes()) {
    out << ".TP\n.B " << exit.code << "\n" << roff(exit.meaning) << "\n";
  }
  out << ".SH SEE ALSO\n" << see_also;
  return out.str();
}

/// The value of an option, such as "FILE" or "cut|stream", without the default; empty for a switch.
std::string value_name(const po::option_description& option) {
  const std::string text = option.format_parameter();
  return text.substr(0, text.find(" (="));
}

/// The default, unless there is none or the description states it.
std::string default_of(const po::option_description& option) {
  const std::string text = option.format_parameter();
  const std::size_t at = text.find(" (=");
  if (at == std::string::npos || option.description().find("default") != std::string::npos) {
    return {};
  }
  return text.substr(at + 3, text.size() - at - 4);
}

std::string long_option(const po::option_description& option) {
  return "--" + option.long_name();
}

/// "-o", or nothing.
std::string short_option(const po::option_description& option) {
  const std::string name =
      option.canonical_display_name(po::command_line_style::allow_dash_for_short);
  return name.size() == 2 && name[0] == '-' ? name : std::string();
}

std::string option_entry(const po::option_description& option) {
  std::ostringstream out;
  out << ".TP\n";
  if (const std::string name = short_option(option); !name.empty()) {
    out << "\\fB" << roff(name) << "\\fR, ";
  }
  out << "\\fB" << roff(long_option(option)) << "\\fR";
  if (const std::string value = value_name(option); !value.empty()) {
    out << " \\fI" << roff(value) << "\\fR";
  }
  out << "\n" << roff(option.description());
  if (const std::string value = default_of(option); !value.empty()) {
    out << " (default: " << roff(value) << ")";
  }
  out << "\n";
  return out.str();
}

bool is_path(std::string_view value) {
  return value == "FILE" || value == "FOLDER" || value == "STAGE";
}

/// A command's cases in the completion script: words after an option, and all options.
void put_cases(std::ostringstream& values, std::ostringstream& options,
               const DescribedCommand& described) {
  const std::string_view name = described.command->name();
  options << "    " << name << ") words='";
  const po::options_description shown = described_only(described.options);
  for (const auto& option : shown.options()) {
    options << long_option(*option) << " ";
    const std::string value = value_name(*option);
    if (value.empty()) continue;
    values << "    '" << name << " " << long_option(*option) << "'";
    if (const std::string brief = short_option(*option); !brief.empty()) {
      values << " | '" << name << " " << brief << "'";
    }
    std::string words = value;
    std::replace(words.begin(), words.end(), '|', ' ');
    if (is_path(value)) {
      values << ") compopt -o default; return ;;\n";
    } else if (words == value) {
      values << ") return ;;\n";  // a number or text: nothing to offer
    } else {
      values << ") words='" << words << "' ;;\n";
    }
  }
  options << "' ;;\n";
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw_errno("cannot write", path.string());
}

}  // namespace

DescribedCommand::DescribedCommand(std::unique_ptr<Command> named)
    : command(std::move(named)), options("Options", 100, 50) {
  command->setup(options, positional);
  options.add_options()("config", po::value<std::string>()->value_name("FILE"),
                        "read options from a file, one NAME = VALUE a line")("help,h",
                                                                             "show this text");
}

po::options_description described_only(const po::options_description& all) {
  po::options_description shown("Options");
  for (const auto& option : all.options()) {
    if (!option->description().empty()) shown.add(option);
  }
  return shown;
}

const std::vector<ExitCode>& exit_codes() {
  static const std::vector<ExitCode> k_codes = {
      {0, "done"},
      {1, "failed"},
      {2, "wrong usage"},
      {3, "incomplete; the same command continues"},
  };
  return k_codes;
}

std::string man_page(const DescribedCommands& commands) {
  std::ostringstream out;
  out << page_head("meshfarm",
                   "simplify triangle meshes that do not fit into one computer's memory")
      << ".SH SYNOPSIS\n.B meshfarm\n.I COMMAND\n[\\fIOPTIONS\\fR]\n.SH COMMANDS\n";
  std::string pages;
  for (const auto& described : commands) {
    const std::string name(described->command->name());
    out << ".TP\n\\fB" << roff(name) << "\\fR\n" << roff(described->command->summary()) << "\n";
    if (!pages.empty()) pages += ",\n";
    pages += ".BR meshfarm\\-" + roff(name) + " (1)";
  }
  out << page_foot(pages + "\n");
  return out.str();
}

std::string man_page(const DescribedCommand& described) {
  const std::string name = "meshfarm-" + std::string(described.command->name());
  std::ostringstream out;
  out << page_head(name, described.command->summary()) << ".SH SYNOPSIS\n\\fBmeshfarm "
      << roff(described.command->name()) << "\\fR " << roff(described.command->synopsis())
      << "\n.SH OPTIONS\n";
  const po::options_description shown = described_only(described.options);
  for (const auto& option : shown.options()) out << option_entry(*option);
  out << page_foot(".BR meshfarm (1)\n");
  return out.str();
}

std::string bash_completion(const DescribedCommands& commands) {
  std::ostringstream values;
  std::ostringstream options;
  std::string names;
  for (const auto& described : commands) {
    names += std::string(described->command->name()) + " ";
    put_cases(values, options, *described);
  }
  std::ostringstream out;
  out << "# bash completion of meshfarm, made by the program from its options.\n"
         "_meshfarm() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} before=$((COMP_CWORD - 1)) words=\n"
         "  # In --name=value the = is a word of its own.\n"
         "  if [[ $current == = ]]; then current=; before=$COMP_CWORD; fi\n"
         "  if [[ ${COMP_WORDS[before]} == = ]]; then before=$((before - 1)); fi\n"
         "  if ((COMP_CWORD == 1)) || [[ ${COMP_WORDS[1]} == help ]]; then\n"
         "    mapfile -t COMPREPLY < <(compgen -W '"
      << names
      << "help --help --version' -- \"$current\")\n"
         "    return\n"
         "  fi\n"
         "  case \"${COMP_WORDS[1]} ${COMP_WORDS[before]}\" in\n"
      << values.str()
      << "  esac\n"
         "  if [[ -z $words && $current != -* ]]; then compopt -o default; return; fi\n"
         "  [[ -n $words ]] || case ${COMP_WORDS[1]} in\n"
      << options.str()
      << "  esac\n"
         "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
         "}\n"
         "complete -F _meshfarm meshfarm\n";
  return out.str();
}

void write_manual(const std::filesystem::path& folder) {
  DescribedCommands commands;
  for (auto& command : all_commands()) {
    commands.push_back(std::make_unique<DescribedCommand>(std::move(command)));
  }
  std::filesystem::create_directories(folder / "man1");
  std::filesystem::create_directories(folder / "completions");
  write_text(folder / "man1" / "meshfarm.1", man_page(commands));
  for (const auto& described : commands) {
    const std::string name = "meshfarm-" + std::string(described->command->name()) + ".1";
    write_text(folder / "man1" / name, man_page(*described));
  }
  write_text(folder / "completions" / "meshfarm", bash_completion(commands));
}

}  // namespace meshfarm
