// Messages for a command line that CLI11 rejects.
#include <algorithm>
#include <vector>

#include "app/commands.h"
#include "lib/scene/file_kind.h"
#include "lib/scene/suggest.h"

namespace pbf::app_module {
namespace {

std::vector<std::string> names(const std::vector<const CLI::App*>& commands) {
  std::vector<std::string> all;
  for (const CLI::App* c : commands) all.push_back(c->get_name());
  return all;
}

/// "; did you mean --threads?" for "--thread=4".
std::string nearest_option(const CLI::App& command, const std::string& written) {
  const std::size_t begin = written.find_first_not_of('-');
  if (begin == std::string::npos) return "";
  const std::string word = written.substr(begin, written.find('=') - begin);
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) known.push_back(name);
  const std::string near = nearest_choice(word, known);
  return near.empty() ? "" : "; did you mean --" + near + "?";
}

bool takes_files(const CLI::App& command) {
  return !command.get_options([](const CLI::Option* o) { return o->get_positional(); }).empty();
}

/// The message for an unexpected argument; empty: use that of CLI11.
std::string of_extra(const CLI::App& command, const std::string& extra) {
  const std::string pbf = "pbf " + command.get_name();
  if (extra.size() > 1 && extra[0] == '-')
    return extra + ": " + pbf + " has no such option" + nearest_option(command, extra);
  if (!takes_files(command)) return extra + ": " + pbf + " takes no file, only options";
  const std::size_t equals = extra.find('=');
  if (equals != std::string::npos && equals > 0 && command.get_option_no_throw("--set") != nullptr)
    return extra + ": not expected here; did you mean --set " + extra + "?";
  if (has_scene_name(extra))
    return extra + ": " + pbf +
           " takes one file; pbf batch runs many: all scenes of a folder, or a "
           "text file that names one per line";
  return "";
}

}  // namespace

std::string explain(const CLI::App& app, const CLI::ParseError& e) {
  const auto chosen = app.get_subcommands();
  std::vector<std::string> extras = app.remaining(true);
  // If all positional arguments are used, the extra one is only in the message.
  const std::string what = e.what(), before = "not expected: ";
  if (const std::size_t at = what.find(before); extras.empty() && at != std::string::npos)
    extras.push_back(what.substr(at + before.size()));
  if (!chosen.empty()) {
    std::string message;
    if (dynamic_cast<const CLI::ExtrasError*>(&e) && !extras.empty())
      message = std::ranges::find(extras, "=") != extras.end()
                    ? "=: not expected here; a setting is one word without spaces, KEY.PATH=VALUE"
                    : of_extra(*chosen[0], extras[0]);
    else if (dynamic_cast<const CLI::RequiredError*>(&e) && what.find("at most 1") != what.npos)
      message = "give one of " + what.substr(std::min(what.size(), what.find('[')));
    if (message.empty()) message = what;
    return message + "\nSee pbf " + chosen[0]->get_name() + " --help";
  }
  const auto commands =
      names(app.get_subcommands([](const CLI::App* c) { return !c->get_group().empty(); }));
  std::string message = what, meant;
  if (!extras.empty() && extras[0][0] != '-') {
    message = extras[0] + ": unknown command";
    meant = has_scene_name(extras[0]) ? "run " + extras[0] : nearest_word(extras[0], commands);
    if (!meant.empty()) message += ", did you mean pbf " + meant + "?";
  }
  message += "; the commands are";
  for (const std::string& c : commands) message += " " + c;
  return message + "\nSee pbf --help";
}

}  // namespace pbf::app_module
