#include "lib/render/texts.h"

#include <array>

#include "lib/render/font.h"

namespace pbf::render_module {

TextBox Texts::box_of(const std::string& text, double x, double y) const {
  return {x, y - 0.28 * size_, x + text_width(text, size_),
          y + (kCapitalHeight + kDescent) * size_};
}

bool Texts::fits(const TextBox& box) const {
  const double r = rim();
  return box.x0 >= r && box.y0 >= 0 && box.x1 <= image_.width - r && box.y1 <= image_.height &&
         std::none_of(taken_.begin(), taken_.end(), [&](const TextBox& b) { return b.meets(box); });
}

void Texts::put(const std::string& text, double x, double y, Rgb color) {
  constexpr Rgb light{246, 248, 250};
  const TextBox box = box_of(text, x, y);
  if (text.empty() || !fits(box)) return;
  taken_.push_back(box);
  const double r = rim();
  for (const auto& [dx, dy] : {std::array{-r, 0.0}, {r, 0.0}, {0.0, -r}, {0.0, r}})
    draw_text(image_, text, x + dx, y + dy, size_, light);
  draw_text(image_, text, x, y, size_, color);
}

}  // namespace pbf::render_module
