// SPDX-License-Identifier: Apache-2.0
#include "host/picture/view_font.h"

#include <array>
#include <string_view>

namespace kilolux {
namespace {

struct Glyph {
    char character;
    std::string_view rows;  // 7 rows of 5, '#' is ink
};

constexpr std::array kGlyphs = {Glyph{'0', " ### #   ##  ### # ###  ##   # ### "},
                                Glyph{'1', "  #   ##    #    #    #    #   ### "},
                                Glyph{'2', " ### #   #    #   #   #   #   #####"},
                                Glyph{'3', " ### #   #    #  ##     ##   # ### "},
                                Glyph{'4', "   #   ##  # # #  # #####   #    # "},
                                Glyph{'5', "######    ####     #    ##   # ### "},
                                Glyph{'6', " ### #    #    #### #   ##   # ### "},
                                Glyph{'7', "#####    #   #   #   #    #    #   "},
                                Glyph{'8', " ### #   ##   # ### #   ##   # ### "},
                                Glyph{'9', " ### #   ##   # ####    #    # ### "},
                                Glyph{'.', "                          ##   ##  "},
                                Glyph{'-', "               #####               "},
                                Glyph{'+', "       #    #  #####  #    #       "},
                                Glyph{'/', "    #    #   #   #   #   #    #    "},
                                Glyph{'*', "       #  # # # ### # # #  #       "},
                                Glyph{'%', "##  ###  #   #   #   #   #  ###  ##"},
                                Glyph{'A', " ### #   ##   #######   ##   ##   #"},
                                Glyph{'C', " ### #   ##    #    #    #   # ### "},
                                Glyph{'D', "#### #   ##   ##   ##   ##   ##### "},
                                Glyph{'E', "######    #    #### #    #    #####"},
                                Glyph{'F', "######    #    #### #    #    #    "},
                                Glyph{'G', " ### #   ##    # ####   ##   # ### "},
                                Glyph{'H', "#   ##   ##   #######   ##   ##   #"},
                                Glyph{'I', " ###   #    #    #    #    #   ### "},
                                Glyph{'K', "#   ##  # # #  ##   # #  #  # #   #"},
                                Glyph{'L', "#    #    #    #    #    #    #####"},
                                Glyph{'M', "#   ### ### # ## # ##   ##   ##   #"},
                                Glyph{'N', "#   ###  ## # ##  ###   ##   ##   #"},
                                Glyph{'O', " ### #   ##   ##   ##   ##   # ### "},
                                Glyph{'P', "#### #   ##   ##### #    #    #    "},
                                Glyph{'R', "#### #   ##   ##### # #  #  # #   #"},
                                Glyph{'S', " ### #   ##     ###     ##   # ### "},
                                Glyph{'T', "#####  #    #    #    #    #    #  "},
                                Glyph{'U', "#   ##   ##   ##   ##   ##   # ### "},
                                Glyph{'V', "#   ##   ##   ##   ##   # # #   #  "},
                                Glyph{'W', "#   ##   ##   ## # ## # ### ###   #"},
                                Glyph{'X', "#   ##   # # #   #   # # #   ##   #"},
                                Glyph{',', "                     ##    #   #   "},
                                Glyph{':', "      ##   ##        ##   ##       "},
                                Glyph{'(', "   #   #   #    #    #     #     # "},
                                Glyph{')', " #     #     #    #    #   #   #   "},
                                Glyph{'=', "          #####     #####          "},
                                Glyph{'_', "                              #####"},
                                Glyph{'B', "#### #   ##   ##### #   ##   ##### "},
                                Glyph{'J', "  ###   #    #    #    # #  #  ##  "},
                                Glyph{'Q', " ### #   ##   ##   ## # ##  #  ## #"},
                                Glyph{'Y', "#   ##   # # #   #    #    #    #  "},
                                Glyph{'Z', "#####    #   #   #   #   #    #####"}};

}  // namespace

bool has_ink(char character, int x, int y) {
    if (character >= 'a' && character <= 'z') character = static_cast<char>(character - 'a' + 'A');
    for (const Glyph& glyph : kGlyphs) {
        if (glyph.character != character) continue;
        return glyph.rows[static_cast<std::size_t>(y * kGlyphWidth + x)] == '#';
    }
    return false;
}

}  // namespace kilolux
