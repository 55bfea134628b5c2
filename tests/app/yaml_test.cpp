// YAML files as options.
#include "app/options/yaml.h"

#include <gtest/gtest.h>

#include "../message_of.h"

namespace elastogear::app::yaml_test {
namespace {

std::string options_of(const std::string& text) {
  std::string all;
  for (const YamlEntry& entry : parse_yaml(text, "f.yaml")) all += "-" + entry.name + " " + entry.value + ";";
  return all;
}

std::string error_of(const std::string& text) {
  return test::message_of([&] { parse_yaml(text, "f.yaml"); });
}

TEST(Yaml, NestedKeysAreJoined) {
  EXPECT_EQ(options_of("a: 1\nb: {c: 2, d: {e: 3}}\nf_g: [x, 'y z', -1e-7]\nh:\n"),
            "-a 1;-b_c 2;-b_d_e 3;-f_g x,y z,-1e-7;-h ;");
  EXPECT_EQ(options_of("# nothing\n"), "");
}

TEST(Yaml, ItemsThatAreQuotedKeepTheirCommas) {
  EXPECT_EQ(options_of("a: ['FIX, LEFT', \"B,C\", D]\n"), "-a \"FIX, LEFT\",\"B,C\",D;");
}

TEST(Yaml, MapsInListsGiveTheirNameToTheList) {
  EXPECT_EQ(options_of("pc: [{gamg: {k: 1}}, x]\n"), "-pc_gamg_k 1;-pc gamg,x;");
}

TEST(Yaml, AnchorsAndMergeKeysAreUnderstood) {
  EXPECT_EQ(
      options_of("$$steel: &steel {E: 1, nu: 0.3}\nmaterial:\n  nu: 0.2\n  <<: *steel\nother: *steel\n"),
      "-material_nu 0.2;-material_E 1;-other_E 1;-other_nu 0.3;");
}

TEST(Yaml, EachKeyKnowsItsLine) {
  const auto entries = parse_yaml("# c\na: 1\nb:\n  c: 2\n", "f.yaml");
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].line, 2);
  EXPECT_EQ(entries[1].line, 4);
}

TEST(Yaml, KeysThatAreGivenTwiceAreRefused) {
  EXPECT_EQ(error_of("a: 1\nb: 2\na: 3\n"), "f.yaml, line 3: the key a is given twice, first in line 1");
  EXPECT_EQ(error_of("ts: {dt: 1}\nts_dt: 1\n"),
            "f.yaml, line 2: the key ts_dt is given twice, first in line 1");
  EXPECT_EQ(error_of("a: {b: 1}\nc: 2\na: {d: 3}\n"),
            "f.yaml, line 3: the key a is given twice, first in line 1");
  EXPECT_EQ(error_of("ts_dt: 1\n---\nTS_dt: 1\n"),
            "f.yaml, line 3: the key TS_dt is given twice, first in line 1");
}

TEST(Yaml, ErrorsNameTheLine) {
  EXPECT_TRUE(error_of("a: 1\nb: [1, 2\nc: {").starts_with("f.yaml, line 3: is no valid YAML"));
  EXPECT_TRUE(error_of("a: 1\n\tb: 2\n").starts_with("f.yaml, line 2: is no valid YAML"));
  EXPECT_TRUE(error_of("just words\n").starts_with("f.yaml, line 1: must be keys and values"));
  EXPECT_TRUE(error_of("- a\n- b\n").starts_with("f.yaml, line 1: must be keys and values"));
  EXPECT_TRUE(error_of("a: 1\n? [b, c]\n: 2\n").starts_with("f.yaml, line 2: a key must be a word"));
  EXPECT_TRUE(error_of("a: [[1, 2], [3]]\n").starts_with("f.yaml, line 1: a list must hold words"));
  EXPECT_TRUE(error_of("a: 1\n5: 2\n").starts_with("f.yaml, line 2: '5' is no key"));
  EXPECT_TRUE(error_of("a b: 2\n").starts_with("f.yaml, line 1: 'a b' is no key"));
}

TEST(Yaml, EndlessMapsEnd) {
  EXPECT_NE(error_of("a: &a {b: *a}\n").find("nested more than"), std::string::npos);
  for (const std::string bracket : {"[", "{a: "}) {  // at once: libyaml would take minutes
    std::string deep = "a: 1\nb: ";
    for (int i = 0; i < 100000; ++i) deep += bracket;
    EXPECT_NE(error_of(deep).find("line 2: lists and maps are nested more than"), std::string::npos);
  }
  std::string bomb = "$$0: &a0 {x: 1}\n";
  for (int i = 1; i < 30; ++i) {
    const std::string last = std::to_string(i - 1), now = std::to_string(i);
    bomb.append("$$").append(now).append(": &a").append(now).append(" {p").append(now).append(": *a").append(
        last);
    bomb.append(", q").append(now).append(": *a").append(last).append("}\n");
  }
  EXPECT_NE(error_of(bomb + "all: *a29\n").find("holds more than"), std::string::npos);
}

}  // namespace
}  // namespace elastogear::app::yaml_test
