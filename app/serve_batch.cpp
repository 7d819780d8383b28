// pbf serve-batch: runs of a batch, several at a time in one process. Only pbf batch starts it.
#include "app/commands.h"
#include "app/options.h"
#include "lib/base/plain_text.h"
#include "lib/campaign/job_server.h"
#include "lib/run/signals.h"

namespace pbf::app_module {
namespace {

struct ServeOptions {};

int command_serve_batch(const ServeOptions& /*none*/) {
  watch_signals();
  serve_jobs(0, [](const std::vector<std::string>& words) {
    const Ending end = execute(words);
    return JobEnd{end.code, job_message(escaped(end.message))};
  });
  return 0;
}

}  // namespace

void add_serve_batch(CLI::App& app, int& code) {
  add_command(app, code, command_serve_batch, kServeCommand, "", "").first->group("");
}

}  // namespace pbf::app_module
