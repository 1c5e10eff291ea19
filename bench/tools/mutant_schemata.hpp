// Many faults in one build, of which an environment variable chooses one ("mutant schemata": Untch,
// Offutt and Harrold 1993). bench/tools/mutant_schemata.py puts these names into copies of source
// files.
//
// `a < b` becomes `a < PHOTILE_INFIX(Less, 17) < b`: the object between has the operator's own
// precedence on both sides, so that no operand has to be found. PHOTILE_CHOSEN(17) chooses between
// two expressions.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <type_traits>
#include <utility>

namespace photile::mutants {

/// The exit code of a mutant whose operator its operands do not have: it would not have compiled.
inline constexpr int does_not_compile = 97;

inline int chosen() {
  static const int number = [] {
    const char* text = std::getenv("PHOTILE_MUTANT");
    return text == nullptr ? 0 : std::atoi(text);
  }();
  return number;
}

/// Numbers of the mutants that would have given another value, in the file that
/// PHOTILE_MUTANT_RECORD names, once the process ends: no test can notice others.
class Record {
 public:
  static constexpr int most = 100'000;

  Record() : file_(std::getenv("PHOTILE_MUTANT_RECORD")) {}
  ~Record() {
    std::FILE* out = file_ == nullptr ? nullptr : std::fopen(file_, "a");
    if (out == nullptr) return;
    for (int i = 0; i < most; ++i) {
      if (matters_[i]) std::fprintf(out, "%d\n", i);
    }
    std::fclose(out);
  }

  bool runs() const { return file_ != nullptr; }
  void matters(int number) { matters_[number] = true; }  // by many threads, all of which write 1

 private:
  const char* file_;
  bool matters_[most] = {};
};

inline Record& record() {
  static Record instance;
  return instance;
}

/// Whether this is the mutant; for choices whose values are not compared.
inline bool is_chosen(int number) {
  if (record().runs()) record().matters(number);
  return chosen() == number;
}

/// Where a whole number cannot be divided by it.
template <class Value>
bool is_zero(const Value& value) {
  if constexpr (std::is_integral_v<Value>) {
    return value == 0;
  } else {
    return false;
  }
}

template <class Value>
bool differ(const Value& a, const Value& b) {
  if constexpr (requires { static_cast<bool>(a == b); }) {
    return !static_cast<bool>(a == b);
  } else {
    return true;
  }
}

/// Ends the process: the operands of a mutant do not have its operator.
[[noreturn]] inline void refuse() { _exit(does_not_compile); }

}  // namespace photile::mutants

#define PHOTILE_CHOSEN(number) ::photile::mutants::is_chosen(number)

// Operators by value: `left` is kept by reference within the full expression.
#define PHOTILE_INFIX_OPERATOR(name, op, other)                                      \
  namespace photile::mutants {                                                       \
  template <int number>                                                              \
  struct name {};                                                                    \
  template <int number, class Left>                                                  \
  struct name##_left {                                                               \
    const Left& left;                                                                \
  };                                                                                 \
  template <int number, class Left>                                                  \
  name##_left<number, Left> operator op(const Left& left, name<number>) {            \
    return {left};                                                                   \
  }                                                                                  \
  template <int number, class Left, class Right>                                     \
  auto operator op(name##_left<number, Left> bound, const Right& right) {            \
    using Result = std::decay_t<decltype(bound.left op right)>;                      \
    if constexpr (requires { static_cast<Result>(bound.left other right); }) {       \
      if (record().runs()) {                                                         \
        if (is_zero(right) || differ(static_cast<Result>(bound.left op right),       \
                                     static_cast<Result>(bound.left other right))) { \
          record().matters(number);                                                  \
        }                                                                            \
      } else if (chosen() == number) {                                               \
        return static_cast<Result>(bound.left other right);                          \
      }                                                                              \
    } else if (is_chosen(number)) {                                                  \
      refuse();                                                                      \
    }                                                                                \
    return static_cast<Result>(bound.left op right);                                 \
  }                                                                                  \
  }

// Assignments bind from the right: `a += (name += b)`.
#define PHOTILE_INFIX_ASSIGNMENT(name, op, other)                             \
  namespace photile::mutants {                                                \
  template <int number>                                                       \
  struct name {};                                                             \
  template <int number, class Right>                                          \
  struct name##_right {                                                       \
    const Right& right;                                                       \
  };                                                                          \
  template <int number, class Right>                                          \
  name##_right<number, Right> operator op(name<number>, const Right& right) { \
    return {right};                                                           \
  }                                                                           \
  template <int number, class Left, class Right>                              \
  Left& operator op(Left& left, name##_right<number, Right> bound) {          \
    if (is_chosen(number)) {                                                  \
      if constexpr (requires { left other bound.right; }) {                   \
        left other bound.right;                                               \
      } else {                                                                \
        refuse();                                                             \
      }                                                                       \
    } else {                                                                  \
      left op bound.right;                                                    \
    }                                                                         \
    return left;                                                              \
  }                                                                           \
  }

PHOTILE_INFIX_OPERATOR(Less, <, <=)
PHOTILE_INFIX_OPERATOR(LessOrEqual, <=, <)
PHOTILE_INFIX_OPERATOR(Greater, >, >=)
PHOTILE_INFIX_OPERATOR(GreaterOrEqual, >=, >)
PHOTILE_INFIX_OPERATOR(Equal, ==, !=)
PHOTILE_INFIX_OPERATOR(Unequal, !=, ==)
PHOTILE_INFIX_OPERATOR(Plus, +, -)
PHOTILE_INFIX_OPERATOR(Minus, -, +)
PHOTILE_INFIX_OPERATOR(Times, *, /)
PHOTILE_INFIX_OPERATOR(Over, /, *)
PHOTILE_INFIX_OPERATOR(Rest, %, /)
PHOTILE_INFIX_OPERATOR(BothBits, &, |)
PHOTILE_INFIX_OPERATOR(AnyBits, |, &)
PHOTILE_INFIX_OPERATOR(ShiftUp, <<, >>)
PHOTILE_INFIX_OPERATOR(ShiftDown, >>, <<)
PHOTILE_INFIX_ASSIGNMENT(Add, +=, -=)
PHOTILE_INFIX_ASSIGNMENT(Subtract, -=, +=)
PHOTILE_INFIX_ASSIGNMENT(Multiply, *=, /=)
PHOTILE_INFIX_ASSIGNMENT(Divide, /=, *=)

#define PHOTILE_INFIX(name, number) \
  ::photile::mutants::name<number> {}

#define PHOTILE_EXTREME(number, function, other)                                                  \
  ([](const auto&... values) {                                                                    \
    const auto own = function(values...), changed = other(values...);                             \
    if (::photile::mutants::record().runs()) {                                                    \
      if (::photile::mutants::differ(own, changed)) ::photile::mutants::record().matters(number); \
      return own;                                                                                 \
    }                                                                                             \
    return ::photile::mutants::chosen() == number ? changed : own;                                \
  })
