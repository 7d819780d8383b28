// Small helpers for text: numbers and durations for people, names of files, times.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pbf::base_module {

/// "a, b, c" with ", " as the separator.
std::string joined(const std::vector<std::string>& parts, const std::string& separator);

/// 12345678 -> "12.3 M"; three digits and a decimal prefix (k M G T) from 1000 on.
std::string si_number(double value);

/// 1536 -> "1.5 KiB".
std::string bytes_text(double bytes);

/// Seconds for people: "0.4 s", "12 s", "3 min 20 s", "2 h 05 min".
std::string duration_text(double seconds);

/// Whether the text can be the name of a file within a folder: not empty, not "." or "..", no
/// slash, tab or line break, valid text (plain_text.h), at most 200 bytes.
bool is_file_name(std::string_view text);

/// The present time, UTC, ISO 8601: "2024-05-01T12:00:00Z".
std::string utc_now();
/// Such a text in seconds, for differences of times; nothing for a text of another form.
std::optional<double> utc_seconds(const std::string& text);

}  // namespace pbf::base_module
