"""A weather file of a year that was never measured, for benches and examples: EPW without downloads.

    bench/lighting/weather_year.py FILE.epw [--latitude 52.5] [--longitude 13.4] [--time-zone 1] [--seed 1]

Clear-sky irradiances by the ASHRAE model (A = 1,120 W/m2, B = 0.18, diffuse factor 0.11), under clouds that
are drawn for each day and change from hour to hour. The same seed gives the same file.
"""

import argparse
import datetime
import math
import random

CLEAR_SUN, EXTINCTION, CLEAR_DIFFUSE = 1120.0, 0.18, 0.11
LEAST_ELEVATION = math.radians(3)  # the sun of an hour is not on the horizon


def sine_of_elevation(latitude, longitude, time_zone, day, hour):
    """Of the sun, by its mean declination and the equation of time."""
    declination = math.radians(23.45) * math.sin(2 * math.pi * (284 + day) / 365)
    b = 2 * math.pi * (day - 81) / 364
    minutes = 9.87 * math.sin(2 * b) - 7.53 * math.cos(b) - 1.5 * math.sin(b)
    solar = hour + minutes / 60 + (longitude - 15 * time_zone) / 15
    latitude = math.radians(latitude)
    return (math.sin(latitude) * math.sin(declination)
            + math.cos(latitude) * math.cos(declination) * math.cos(math.radians(15 * (solar - 12))))


def irradiances(sine, cloud):
    """Direct normal and diffuse horizontal, W/m2; `cloud` from 0 to 1."""
    if sine <= math.sin(LEAST_ELEVATION):
        return 0, 0
    clear = CLEAR_SUN * math.exp(-EXTINCTION / sine)
    direct = clear * max(0.0, 1 - 1.3 * cloud)
    diffuse = CLEAR_DIFFUSE * clear + (0.45 * cloud - 0.3 * cloud * cloud) * clear * sine
    return round(direct), max(1, round(diffuse))


def weather_text(latitude, longitude, time_zone, seed):
    clouds = random.Random(seed)
    lines = [f"LOCATION,Made up,-,ZZZ,photile bench,000000,{latitude:.2f},{longitude:.2f},{time_zone:.1f},34.0",
             "DESIGN CONDITIONS,0", "TYPICAL/EXTREME PERIODS,0", "GROUND TEMPERATURES,0",
             "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0", "COMMENTS 1,No measured weather", "COMMENTS 2,",
             "DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31"]
    for number in range(365):
        date = datetime.date(2005, 1, 1) + datetime.timedelta(number)
        of_day = clouds.betavariate(0.6, 0.5)
        for hour in range(1, 25):
            cloud = min(1.0, max(0.0, of_day + clouds.gauss(0, 0.12)))
            sine = sine_of_elevation(latitude, longitude, time_zone, number + 1, hour - 0.5)
            direct, diffuse = irradiances(sine, cloud)
            total = round(direct * max(0.0, sine) + diffuse)
            lines.append(f"2005,{date.month},{date.day},{hour},60,?9?9?9?9E0?9?9?9?9?9?9?9,10.0,11.0,80,101300,"
                         f"0,0,300,{total},{direct},{diffuse},0,0,0,0,0,3.0,5,5,20.0,77777,9,999999999,110,"
                         f"0.1,0,88,0.2,0.0,1.0")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file")
    parser.add_argument("--latitude", type=float, default=52.5)
    parser.add_argument("--longitude", type=float, default=13.4)
    parser.add_argument("--time-zone", type=float, default=1)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    with open(given.file, "w") as file:
        file.write(weather_text(given.latitude, given.longitude, given.time_zone, given.seed))


if __name__ == "__main__":
    main()
