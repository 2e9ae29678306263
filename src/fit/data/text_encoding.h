// text_encoding.h — the bytes of a machine's file as UTF-8: with or without a mark, UTF-16 of both orders, Latin-1.
#pragma once

#include <string>

namespace glisson::fit {

struct DecodedText {
  std::string text;     ///< UTF-8, without a mark at its beginning
  std::string problem;  ///< what the bytes are instead of text, and what to do; empty: nothing is wrong
};

/// Text whose bytes are not UTF-8 is taken for Latin-1, which older machines write (µ, °).
DecodedText decode_text(std::string bytes);

}  // namespace glisson::fit
