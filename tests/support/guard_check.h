// A guard without a session around it.
#pragma once

#include <optional>

#include "lib/run/guard.h"

/// Looks at a new measure: its state is kept, or what is wrong is found.
inline std::optional<pbf::GuardEvent> check(pbf::Guard& guard, const pbf::Diagnostics& m) {
  if (const auto wrong = guard.alarm(m)) return guard.locate(*wrong, m, guard.options());
  guard.keep(m);
  return std::nullopt;
}
