#pragma once
// Options bound to the members of a struct: one row says name, member, unit and meaning. Kind and default of
// the option are those of the member.

#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <type_traits>

#include "app/options/options.h"
#include "elastogear/base/text.h"

namespace elastogear::app {

/// What a row says of its values beside their kind, by bits.
enum : unsigned {
  kPositive = 1,   ///< numbers > 0, counts > 0
  kRequired = 2,   ///< the option has no default: it must be given where the struct has not got a value
  kDependent = 4,  ///< the default depends on other options and is not in the table
};

/// An optional member is empty unless its option is given.
template <class T>
constexpr bool kIsOptional = false;
template <class T>
constexpr bool kIsOptional<std::optional<T>> = true;

/// A map holds the values of all options that fit a name with a placeholder, by the word in its place.
template <class T>
constexpr bool kIsByWord = false;
template <class T>
constexpr bool kIsByWord<std::map<std::string, T>> = true;

/// The value of an option as a user would write it; empty where there is none.
template <class T>
std::string default_text(const T& value) {
  std::ostringstream text;
  text.precision(10);
  if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>)
    text << std::boolalpha << value;
  else if constexpr (kIsOptional<T>)
    text << (value ? default_text(*value) : "");
  else if constexpr (!kIsByWord<T>)
    text << join(value, ",", [](const auto& part) { return default_text(part); });
  return text.str();
}

/// Reads an option, which is given or has a default. positive: see kPositive.
template <class T>
T value_of(const Options& options, const std::string& name, bool positive) {
  if constexpr (kIsOptional<T>)
    return value_of<typename T::value_type>(options, name, positive);
  else if constexpr (std::is_same_v<T, bool>)
    return options.flag(name);
  else if constexpr (std::is_same_v<T, int>)
    return options.count(name, positive);
  else if constexpr (std::is_same_v<T, double>)
    return positive ? options.positive(name) : options.number(name);
  else if constexpr (std::is_same_v<T, std::string>)
    return options.text(name);
  else if constexpr (std::is_same_v<T, Eigen::Vector3d>)
    return options.vector(name);
  else if constexpr (std::is_same_v<T, std::vector<double>>)
    return options.numbers(name);
  else
    return options.list(name);
}

/// "worm_file" of "<body>_file" and "worm".
inline std::string with_word(std::string name, const std::string& word) {
  const auto open = name.find('<');
  return open == name.npos ? name : name.replace(open, name.find('>') - open + 1, word);
}

/// Reads all options that fit a pattern such as "stress_<body>", each by the word in place of its
/// placeholder.
template <class T>
std::map<std::string, T> values_by_word(const Options& options, const std::string& pattern, bool positive) {
  std::map<std::string, T> values;
  for (const std::string& word : options.placeholder_values(pattern))
    values[word] = value_of<T>(options, with_word(pattern, word), positive);
  return values;
}

template <class... Words>
std::vector<std::string> one_of(const Words&... words) {
  return {words...};
}

/// One option of a struct S.
template <class S>
struct Row {
  using Read = std::function<void(const Options&, const std::string& name, S&)>;

  OptionSpec spec;
  Read read = {};  ///< empty: the option is read elsewhere

  /// An option that is no single member of S.
  Row(std::string name, std::string unit, std::string default_value, std::string help, Read reader = {})
      : spec{std::move(name), std::move(unit), std::move(default_value), std::move(help)},
        read(std::move(reader)) {}

  /// member: a pointer to a member, or a function from S& to a reference. A map from words takes all options
  /// that fit the name with its placeholder.
  template <class Member>
  requires std::is_invocable_v<Member, S&> Row(std::string name, Member member, const char* unit,
                                               std::string help, unsigned bits = 0)
      : spec{std::move(name), unit, "", std::move(help)} {
    using Value = std::remove_cvref_t<std::invoke_result_t<Member, S&>>;
    const bool required = bits & kRequired, positive = bits & kPositive;
    if (S s{}; !required && !(bits & kDependent)) spec.default_value = default_text(std::invoke(member, s));
    if constexpr (kIsByWord<Value>)
      read = [=, pattern = spec.name](const Options& options, const std::string&, S& s) {
        std::invoke(member, s) = values_by_word<typename Value::mapped_type>(options, pattern, positive);
      };
    else
      read = [=](const Options& options, const std::string& key, S& s) {
        S defaults{};
        if (options.given(key) || (required && std::invoke(member, s) == std::invoke(member, defaults)))
          std::invoke(member, s) = value_of<Value>(options, key, positive);
      };
  }

  /// words, see one_of: one for each value of the member, in its order: of an enumeration, an index, or false
  /// and true.
  template <class Member>
  requires std::is_invocable_v<Member, S&> Row(std::string name, Member member,
                                               std::vector<std::string> words, std::string help)
      : spec{std::move(name), "-", "", std::move(help)} {
    using Value = std::remove_cvref_t<std::invoke_result_t<Member, S&>>;
    S defaults{};
    spec.default_value = words[static_cast<std::size_t>(std::invoke(member, defaults))];
    read = [=](const Options& options, const std::string& key, S& s) {
      if (options.given(key)) std::invoke(member, s) = static_cast<Value>(options.choice(key, words));
    };
  }
};

template <class S>
using Rows = std::vector<Row<S>>;

/// The member `inner` of the member `outer`.
template <class Outer, class Inner>
auto in(Outer outer, Inner inner) {
  return [=](auto& s) -> auto& { return s.*outer.*inner; };
}

/// Sets the members whose options are given, in the order of the rows. word: stands for their placeholder.
template <class S>
void read_rows(const Options& options, const Rows<S>& rows, S& s, const std::string& word = "") {
  for (const Row<S>& row : rows)
    if (row.read) row.read(options, with_word(row.spec.name, word), s);
}

/// All rows, in their order.
template <class... S>
OptionTable table_of(const Rows<S>&... rows) {
  OptionTable table;
  const auto add = [&table](const auto& some) {
    for (const auto& row : some) table.push_back(row.spec);
  };
  (add(rows), ...);
  return table;
}

}  // namespace elastogear::app
