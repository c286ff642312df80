// SPDX-License-Identifier: Apache-2.0
#include "daemon/printable.hpp"

#include <doctest/doctest.h>

namespace warren {

TEST_CASE("what a terminal takes for a command becomes a blank") {
  CHECK(printable("found one") == "found one");
  CHECK(printable("a\nb\x1b[2Jc\x7f") == "a b [2Jc ");
  // The same escape as one character, as Latin-1 has it.
  CHECK(printable("a\xC2\x9BKb") == "a Kb");
  CHECK(printable("\xC2\x80\xC2\x9F") == "  ");
}

TEST_CASE("letters of all kinds stay, and so do bytes that are none") {
  CHECK(printable("Gr\u00FC\u00DFe, \u20AC\u00A0") == "Gr\u00FC\u00DFe, \u20AC\u00A0");
  CHECK(printable("\xC2") == "\xC2");
  CHECK(printable("\x9B") == "\x9B");
}

}  // namespace warren
