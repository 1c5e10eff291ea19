// Figures of a year of daylight on the live page, which the server measures when it is asked.

class Year {
  constructor(live) {
    this.start = element('button', {type: 'button', textContent: 'Measure the year',
                                    title: 'Daylight of each hour of the weather file, 0.85 m above the floor'});
    this.start.addEventListener('click', () => live.post('year', {}));
    this.lines = element('ul');
    const section = element('section', {id: 'year'}, this.start, this.lines);
    section.setAttribute('aria-label', 'Daylight of the year');
    find('#lights').before(section);
  }

  show({running, lines}) {
    this.start.disabled = running;
    this.start.textContent = running ? 'Measuring the year …' : lines.length > 0 ? 'Measure again' : 'Measure the year';
    this.lines.replaceChildren(...lines.map((line) => element('li', {textContent: line})));
    this.lines.hidden = lines.length === 0;
  }
}
