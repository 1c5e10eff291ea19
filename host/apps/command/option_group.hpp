// Options of a command under one title of its help.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command/validators.hpp"

namespace photile::app {

/// Adds options to a command, all under one title of its help.
///   type     what stands for the value in the help, "" = the words that it may be
///   values   checks the text of a value, and may rewrite it
class OptionGroup {
 public:
  explicit OptionGroup(CLI::App& command, std::string title = "Options")
      : command_(command), title_(std::move(title)) {}

  template <class Value>
  CLI::Option* add(const std::string& names, Value& value, const std::string& type,
                   const std::string& help, const CLI::Validator& values = {}) const {
    return placed(command_.add_option(names, value, help), type, values);
  }

  /// May be given several times, each with one value.
  template <class Value>
  CLI::Option* repeat(const std::string& names, std::vector<Value>& all, const std::string& type,
                      const std::string& help, const CLI::Validator& values = {}) const {
    return add(names, all, type, help, values)->allow_extra_args(false);
  }

  /// Gives the text to `take`.
  CLI::Option* call(const std::string& names, const std::function<void(const std::string&)>& take,
                    const std::string& type, const std::string& help,
                    const CLI::Validator& values = {}) const {
    return placed(command_.add_option_function<std::string>(names, take, help), type, values);
  }

  /// A text that Value::parse reads.
  template <class Value>
  CLI::Option* parse(const std::string& names, std::optional<Value>& value, const std::string& type,
                     const std::string& help) const {
    const auto take = [&value](const std::string& text) { value = Value::parse(text); };
    return call(names, take, type, help);
  }

  /// Several such texts: the option may be given several times.
  template <class Value>
  CLI::Option* parse(const std::string& names, std::vector<Value>& all, const std::string& type,
                     const std::string& help) const {
    const auto take = [&all](const std::vector<std::string>& texts) {
      for (const std::string& text : texts) all.push_back(Value::parse(text));
    };
    return placed(command_.add_option_function<std::vector<std::string>>(names, take, help), type)
        ->allow_extra_args(false);
  }

  /// One of `all` by its name_of; `take` is given it.
  template <class Values, class Value, class Take>
  CLI::Option* choose(const std::string& names, const Values& all, const Value& initial,
                      const std::string& help, const Take& take) const {
    Words words;
    for (const Value& one : all) words.words.emplace_back(name_of(one));
    const auto take_named = [&all, take](const std::string& name) {
      for (const Value& one : all) {
        if (name_of(one) == name) take(one);
      }
    };
    return call(names, take_named, fmt::format("{}", fmt::join(words.words, "|")), help,
                within(words))
        ->default_str(std::string(name_of(initial)));
  }

  CLI::Option* call_flag(const std::string& names, const std::function<void()>& act,
                         const std::string& help) const {
    return command_.add_flag_callback(names, act, help)->group(title_);
  }

  CLI::Option* flag(const std::string& names, bool& value, const std::string& help) const {
    return command_.add_flag(names, value, help)->group(title_);
  }

 private:
  CLI::Option* placed(CLI::Option* option, const std::string& type,
                      const CLI::Validator& values = {}) const {
    return option->type_name(type)->transform(values)->group(title_);
  }

  CLI::App& command_;
  std::string title_;
};

}  // namespace photile::app
