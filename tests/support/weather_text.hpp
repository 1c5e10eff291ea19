// Weather files made up for tests.
#pragma once

#include <functional>
#include <string>

namespace photile::test {

/// W/m2 of an hour of the year, 1 to 24.
using IrradianceOf = std::function<int(int month, int day, int hour)>;

/// An EPW file of a common year somewhere at 52.5 degrees north, 13.4 east.
inline std::string weather_text(const IrradianceOf& direct, const IrradianceOf& diffuse) {
  constexpr int days[]{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  std::string text =
      "LOCATION,Somewhere,-,ZZZ,test,000000,52.50,13.40,1.0,34.0\nDESIGN CONDITIONS,0\n"
      "TYPICAL/EXTREME PERIODS,0\nGROUND TEMPERATURES,0\nHOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\n"
      "COMMENTS 1,\nCOMMENTS 2,\nDATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n";
  for (int month = 1; month <= 12; ++month) {
    for (int day = 1; day <= days[month - 1]; ++day) {
      for (int hour = 1; hour <= 24; ++hour) {
        text += "2005," + std::to_string(month) + "," + std::to_string(day) + "," +
                std::to_string(hour) + ",60,?9,10.0,5.5,70,101300,0,0,300,0," +
                std::to_string(direct(month, day, hour)) + "," +
                std::to_string(diffuse(month, day, hour)) + ",0,0,0\n";
      }
    }
  }
  return text;
}

}  // namespace photile::test
