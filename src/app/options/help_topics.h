#pragma once
// Options by topic, as -help prints them: those of first need, or all, or those about one word.

#include <string>

#include "app/options/option_table.h"

namespace elastogear::app {

/// The options of a table under the headings of their topics. about: "" for those of first need, with what
/// asks for the others; "all"; or a word that the name of an option, its meaning or its topic holds. Empty
/// where no option holds the word.
/// Options that no topic names stand under "other options".
std::string help_by_topic(const OptionTable& table, const std::string& about);

}  // namespace elastogear::app
