#include "prowl/text/shown_text.hpp"

#include <gtest/gtest.h>

namespace prowl {
namespace {

TEST(ShownText, LeavesWhatATerminalMayShow) {
  for (const char* text : {"", "plain", "two\nlines\tand a tab", "Kräfte, Ω, 足, 🐾", "<b>&amp;</b>", "~"})
    EXPECT_EQ(printable(text), text);
}

TEST(ShownText, WritesControlCharactersOut) {
  EXPECT_EQ(printable("\x1b[2J"), "\\x1b[2J");
  EXPECT_EQ(printable("a\rb\x07\x7f"), "a\\x0db\\x07\\x7f");
  EXPECT_EQ(printable(std::string("nul\0!", 5)), "nul\\x00!");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "\\x9b2J")
      << "CSI of 8 bits, as UTF-8";
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "gpj.exe"),
            "\\u202egpj.exe")
      << "right to left";
}

TEST(ShownText, WritesBytesOutThatAreNotUtf8) {
  EXPECT_EQ(printable("caf\xe9"), "caf\\xe9");
  EXPECT_EQ(printable("\x9b"
                      "2J"),
            "\\x9b2J")
      << "CSI of 8 bits, as it is";
  EXPECT_EQ(printable("\xc0\x9b"), "\\xc0\\x9b") << "a longer form than needed";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half a surrogate pair";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
  EXPECT_EQ(printable("\xe2\x80"), "\\xe2\\x80") << "cut short";
}

TEST(ShownText, CutsWhatIsQuoted) {
  EXPECT_EQ(shown("a\nb"), "a\\nb");
  EXPECT_EQ(shown(std::string(100, 'x')), std::string(100, 'x'));
  EXPECT_EQ(shown(std::string(101, 'x')), std::string(100, 'x') + "... (101 bytes)");
  EXPECT_EQ(shown(std::string(99, 'x') + "ä!"), std::string(99, 'x') + "... (102 bytes)") << "not within a character";
}

}  // namespace
}  // namespace prowl
