#include "lib/program/pass.h"

#include <algorithm>
#include <cstring>

namespace pbf::program_module {
namespace {

/// Adds what a trace shows of an array that a pass has written.
void show(const AccessInfo& a, const PassText& text, std::vector<Written>& to) {
  const FieldInfo& f = *a.field;
  const Shown& s = f.shown;
  const bool elsewhere = *s.stage && std::strcmp(s.stage, text.stage) != 0;
  const Written all{&f,
                    f.components == 4 ? Written::vector : Written::scalar,
                    s.quantity,
                    s.unit,
                    elsewhere ? s.stage : nullptr,
                    s.sum};
  // Passes copy unchanged values into the second array of a pair. These are not shown.
  if (*s.quantity && !f.first) to.push_back(all);
  if (a.w == W::lambda) to.push_back({&f, Written::fourth, "lambda", "h^2", nullptr, true});
  if (a.w == W::inverse_density)
    to.push_back({&f, Written::fourth, "1/density", "1/rho0", nullptr});
}

/// The main result of a pass, if it is one number per particle; otherwise -1.
int stored_in(const std::vector<Written>& written) {
  for (std::size_t k = 0; k < written.size(); ++k)
    if (written[k].part == Written::fourth && written[k].field->first) return int(k);
  for (std::size_t k = 0; k < written.size(); ++k)
    if (written[k].part == Written::scalar && written[k].field->type == Type::real) return int(k);
  return -1;
}

bool touches(const std::vector<AccessInfo>& needs, const FieldInfo& f, unsigned how) {
  return std::any_of(needs.begin(), needs.end(),
                     [&](const AccessInfo& a) { return a.field == &f && (a.how & how); });
}

}  // namespace

std::vector<AccessInfo> joined(const std::vector<AccessInfo>& all) {
  std::vector<AccessInfo> out;
  for (const AccessInfo& a : all) {
    const auto same = [&](const AccessInfo& b) { return b.field == a.field; };
    const auto at = std::find_if(out.begin(), out.end(), same);
    if (at == out.end()) {
      out.push_back(a);
      if (!(a.how & kWriting)) out.back().w = W::any;
    } else {
      at->how |= a.how;
      if (a.how & kWriting) at->w = a.w;
      if (a.when == When::always) at->when = When::always;
    }
  }
  return out;
}

bool PassInfo::leaves(W w) const {
  return std::ranges::any_of(needs, [&](const AccessInfo& a) {
    return &a.field->primary() == &field::position && (a.how & kWrites) && a.w == w;
  });
}
bool PassInfo::makes_lists() const { return touches(needs, field::lists, kWriting); }
bool PassInfo::reorders_rows() const { return touches(needs, field::id, kPlaces); }
bool PassInfo::over_pairs() const { return touches(needs, field::lists, kReading); }

bool are_independent(const PassInfo& a, const PassInfo& b) {
  const auto meet = [&](const AccessInfo& use) {
    return touches(b.needs, *use.field, use.how & kWriting ? ~0u : kWriting);
  };
  return a.flips.empty() && b.flips.empty() && std::ranges::none_of(a.needs, meet);
}

PassInfo described(const PassText& text, std::vector<AccessInfo> declared,
                   std::vector<const FieldInfo*> flips) {
  PassInfo info{text, joined(declared), std::move(declared), std::move(flips), {}};
  for (const AccessInfo& a : info.needs) {
    if (!(a.how & (kWrites | kPlaces))) continue;
    if (a.field == &field::lists)
      info.written.push_back({a.field, Written::pairs, "", "", nullptr});
    else
      show(a, text, info.written);
  }
  info.stored = stored_in(info.written);
  return info;
}

}  // namespace pbf::program_module
