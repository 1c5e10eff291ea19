// Photometric files that tests write, of lamps whose light is known in closed form.
#pragma once

#include <fmt/format.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace photile::test {

/// Angles from `first` to `last` in equal steps.
inline std::vector<double> angles(double first, double last, int steps) {
  std::vector<double> result;
  for (int i = 0; i <= steps; ++i) result.push_back(first + (last - first) * i / steps);
  return result;
}

/// An LM-63 file. `candela` is asked for each horizontal and vertical angle, in degrees.
struct IesText {
  std::string first_line = "IESNA:LM-63-2002\n";
  std::string tilt = "TILT=NONE\n";
  std::string lamps = "1 -1";
  double multiplier = 1;
  int type = 1, units = 2;
  std::string ballast = "1 1 0";
  std::vector<double> vertical = angles(0, 180, 2), horizontal = {0};
  std::function<double(double, double)> candela = [](double, double) { return 100.0; };
  std::string separator = " ";
  std::string opening = "0.1 0.1 0";  ///< width, length, height

  std::string str() const {
    std::string text = first_line + "[TEST] none\n[MORE] 5 numbers\n" + tilt;
    text += fmt::format("{} {} {} {} {} {} {}\n{}\n", lamps, multiplier, vertical.size(),
                        horizontal.size(), type, units, opening, ballast);
    for (const double angle : vertical) text += fmt::format("{}{}", angle, separator);
    text += "\n";
    for (const double angle : horizontal) text += fmt::format("{}{}", angle, separator);
    text += "\n";
    for (const double h : horizontal) {
      for (const double v : vertical) text += fmt::format("{}{}", candela(h, v), separator);
      text += "\n";
    }
    return text;
  }
};

/// A EULUMDAT file. `intensity`, cd per 1000 lm, is asked for C and gamma, in degrees.
struct EulumdatText {
  int symmetry = 0, planes = 4;
  std::vector<double> gamma = angles(0, 180, 2);
  double lamp_flux = 2000, conversion = 1;
  int sets = 1;
  bool commas = false;
  std::string colour = "3000", rendering = "80";
  std::function<double(double, double)> intensity = [](double, double) { return 50.0; };
  /// mm: length, width and height of the luminaire, length and width of its opening, heights of its
  /// sides.
  std::array<double, 9> sizes{};

  std::string str() const {
    std::string text = "maker\n1\n";
    const auto number = [&](double value) {
      std::string digits = fmt::format("{}", value);
      const std::size_t point = digits.find('.');
      if (commas && point != std::string::npos) digits[point] = ',';
      text += digits + "\r\n";
    };
    for (const double value : {double(symmetry), double(planes), 360.0 / planes,
                               double(gamma.size()), 180.0 / double(gamma.size() - 1)}) {
      number(value);
    }
    text += "report\nlamp\nnumber\nfile\ndate\n";
    for (const double size : sizes) number(size);
    for (const double value : {50.0, 100.0, conversion, 0.0, double(sets)}) number(value);
    for (int set = 0; set < sets; ++set) {
      text += "1\nlamp\n";
      number(lamp_flux * (1 + set));
      text += colour + "\n" + rendering + "\n";
      number(20);
    }
    for (int i = 0; i < 10; ++i) number(0.5);
    for (int plane = 0; plane < planes; ++plane) number(360.0 * plane / planes);
    for (const double angle : gamma) number(angle);
    const int quarter = planes / 4;
    const int first = symmetry == 3 ? 3 * quarter : 0;
    const int count = symmetry == 0   ? planes
                      : symmetry == 1 ? 1
                      : symmetry == 4 ? quarter + 1
                                      : planes / 2 + 1;
    for (int i = 0; i < count; ++i) {
      for (const double angle : gamma) {
        number(intensity(360.0 * ((first + i) % planes) / planes, angle));
      }
    }
    return text;
  }
};

}  // namespace photile::test
