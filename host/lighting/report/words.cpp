// The words of reports in other languages.

#include <algorithm>
#include <array>

#include "report/page.hpp"

namespace photile::report {
namespace {

/// English and German. A further language is a further column, and a name in `languages`.
constexpr std::array<std::array<std::string_view, 2>, 99> table{{
    {"Illuminance", "Beleuchtungsst\u00e4rke"},
    {"project", "Projekt"},
    {"client", "Auftraggeber"},
    {"designer", "Planer"},
    {"date", "Datum"},
    {"scene", "Szene"},
    {"page", "Seite"},
    {"of", "von"},
    {"Key figures", "Kennwerte"},
    {"required", "gefordert"},
    {"measured", "berechnet"},
    {"at least", "mindestens"},
    {"at most", "h\u00f6chstens"},
    {"met", "erf\u00fcllt"},
    {"not met", "nicht erf\u00fcllt"},
    {"see photile glare", "siehe photile glare"},
    {"see the luminaires' data sheets", "siehe Datenbl\u00e4tter der Leuchten"},
    {"by the luminaires' data sheets", "nach den Datenbl\u00e4ttern der Leuchten"},
    {"Room", "Raum"},
    {"floor area", "Grundfl\u00e4che"},
    {"sides", "Seiten"},
    {"height", "H\u00f6he"},
    {"Energy", "Energie"},
    {"installed power", "installierte Leistung"},
    {"power density", "je Fläche"},
    {"of {}", "von {}"},
    {"LENI (EN 15193)", "LENI (EN 15193)"},
    {"annual energy", "Jahresenergie"},
    {"designed by", "geplant von"},
    {"accepted for the client by", "angenommen f\u00fcr den Auftraggeber von"},
    {"signature", "Unterschrift"},
    {"Pictures", "Bilder"},
    {"as rendered", "wie gerechnet"},
    {"illuminance of the surfaces that are seen, lux",
     "Beleuchtungsst\u00e4rke der sichtbaren Fl\u00e4chen, lx"},
    {"{}: {} points", "{}: {} Punkte"},
    {", {:.2f} x {:.2f} m, {:.2f} m apart", ", {:.2f} x {:.2f} m, Abstand {:.2f} m"},
    {"working plane", "Nutzebene"},
    {"north wall", "Nordwand"},
    {"east wall", "Ostwand"},
    {"south wall", "S\u00fcdwand"},
    {"west wall", "Westwand"},
    {"northeast wall", "Nordostwand"},
    {"southeast wall", "S\u00fcdostwand"},
    {"southwest wall", "S\u00fcdwestwand"},
    {"northwest wall", "Nordwestwand"},
    {"ceiling", "Decke"},
    {"cylindrical", "zylindrisch"},
    {"surroundings", "Umgebung"},
    {"all lights", "alle Leuchten"},
    {"lux", "lx"},
    {"Of many noisy values the least is too low: the true E<sub>min</sub> lies between {} and {} "
     "lux.",
     "Von vielen verrauschten Werten ist der kleinste zu klein: das wahre E<sub>min</sub> liegt "
     "zwischen {} und {} lx."},
    {"Luminaires", "Leuchten"},
    {"number", "Nummer"},
    {"name", "Name"},
    {"kind", "Art"},
    {"photometric file", "Lichtverteilung"},
    {"position (x, y, z), m", "Ort (x, y, z), m"},
    {"luminous flux", "Lichtstrom"},
    {"List of parts", "St\u00fcckliste"},
    {"pieces", "St\u00fcck"},
    {"together", "zusammen"},
    {"maker", "Hersteller"},
    {"article", "Artikel"},
    {"luminaire", "Leuchte"},
    {"lamps", "Lampen"},
    {"power", "Leistung"},
    {"colour temperature", "Farbtemperatur"},
    {"colour rendering", "Farbwiedergabe"},
    {"luminous efficacy", "Lichtausbeute"},
    {"Reflectances", "Reflexionsgrade"},
    {"material", "Material"},
    {"reflectance", "Reflexionsgrad"},
    {"Glare", "Blendung"},
    {"observer", "Beobachter"},
    {"eyes (x, y, z), m", "Augen (x, y, z), m"},
    {"lux at the eye", "lx am Auge"},
    {"A year of daylight", "Ein Jahr Tageslicht"},
    {"mean, lux", "Mittel, lx"},
    {"How it was measured", "Berechnung"},
    {"illuminance", "Beleuchtungsst\u00e4rke"},
    {"planar", "horizontal"},
    {"maintenance factor", "Wartungsfaktor"},
    {"light by", "Licht durch"},
    {"errors", "Fehler"},
    {"program", "Programm"},
    {"mood", "Lichtszene"},
    {"observers", "Beobachter"},
    {"the highest UGR", "h\u00f6chster UGR"},
    {"grid", "Raster"},
    {"weather", "Wetterdaten"},
    {"sky", "Himmel"},
    {"ground", "Gel\u00e4nde"},
    {"Warnings", "Warnungen"},
    {"\u00d7 {} points are not measured: {}.", "\u00d7 {} Punkte sind nicht berechnet: {}."},
    {"\u00d7 {} points are measured, but marked: {}.",
     "\u00d7 {} Punkte sind berechnet, aber fraglich: {}."},
    {"inside a solid or beyond the walls", "in einem K\u00f6rper oder hinter den W\u00e4nden"},
    {"inside a thing or a closed room", "in einem Gegenstand oder geschlossenen Raum"},
    {"less than 1 cm from a surface", "weniger als 1 cm von einer Fl\u00e4che"},
    {"no light", "kein Licht"},
}};

}  // namespace

const std::vector<std::string>& languages() {
  static const std::vector<std::string> names{"en", "de"};
  return names;
}

std::string translated(std::string_view english, std::string_view language) {
  const auto& all = languages();
  const auto column =
      static_cast<std::size_t>(std::find(all.begin(), all.end(), language) - all.begin());
  for (const auto& row : table) {
    if (row[0] == english && column < row.size()) return std::string(row[column]);
  }
  return std::string(english);
}

}  // namespace photile::report
