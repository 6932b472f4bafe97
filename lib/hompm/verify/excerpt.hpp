// Foreign text inside a message.
#pragma once

#include <string>
#include <string_view>

namespace hompm::detail {

/// The beginning of `text` in back quotes, printable whatever it holds.
inline std::string excerpt(std::string_view text) {
  constexpr std::size_t longest = 60;
  constexpr char digits[] = "0123456789abcdef";
  std::string shown = "`";
  for (const char c : text.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      shown += c;
    } else {
      shown += {'\\', 'x', digits[byte / 16], digits[byte % 16]};
    }
  }
  return shown + (text.size() > longest ? "`…" : "`");
}

}  // namespace hompm::detail
