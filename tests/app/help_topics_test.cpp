// Tests of the topics by which the program prints its options as help.
#include "app/options/help_topics.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/verbs/registry.h"

namespace elastogear::app::help_topics_test {
namespace {

std::ptrdiff_t rows(const std::string& help) {
  std::ptrdiff_t n = 0;
  for (std::size_t at = help.find("\n  -"); at != std::string::npos; at = help.find("\n  -", at + 1)) ++n;
  return n;
}

TEST(HelpTopics, hold_every_option_of_every_verb_once) {
  for (const Verb& verb : all_verbs()) {
    std::ptrdiff_t with_help = 0;
    for (const OptionSpec& spec : verb.table) with_help += !spec.help.empty();
    const std::string help = help_by_topic(verb.table, "all");
    EXPECT_EQ(rows(help), with_help) << verb.name;
    const std::size_t others = help.find("other options:");
    EXPECT_EQ(others, std::string::npos) << verb.name << ", name these in src/app/options/help_topics.cpp:\n"
                                         << help.substr(std::min(others, help.size()));
  }
}

TEST(HelpTopics, of_first_need_are_sixty_options_at_most) {
  for (const Verb& verb : all_verbs()) EXPECT_LE(rows(help_by_topic(verb.table, "")), 60) << verb.name;
}

TEST(HelpTopics, of_first_need_in_a_system_are_its_markers_and_loads) {
  for (const Verb& verb : all_verbs()) {
    if (verb.name != "simulate") continue;
    const std::string help = help_by_topic(verb.table, "");
    for (const char* option : {"<body>_points", "loads", "<load>_marker", "<load>_force", "<load>_torque"})
      EXPECT_NE(help.find("\n  -" + std::string(option)), std::string::npos) << option;
  }
}

TEST(HelpTopics, are_chosen_by_a_word_of_names_meanings_and_headings) {
  const OptionTable table = {{"contact_friction", "-", "0", "coefficient of friction"},
                             {"contact_skin", "m", "0", "width of a band"},
                             {"torque", "N m", "0", "on the first gear"}};
  EXPECT_EQ(rows(help_by_topic(table, "Contact")), 2);
  EXPECT_EQ(rows(help_by_topic(table, "gear")), 1);
  EXPECT_EQ(help_by_topic(table, "pizza"), "");
  EXPECT_NE(help_by_topic(table, "").find("1 options more"), std::string::npos);
}

}  // namespace
}  // namespace elastogear::app::help_topics_test
