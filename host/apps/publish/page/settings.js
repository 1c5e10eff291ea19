// How the server of the live page computes light.

class Settings {
  constructor(live) {
    this.live = live;
    this.fields = element('div', {className: 'form'});
    const section = element('section', {id: 'settings'},
        element('details', {}, element('summary', {textContent: 'Photon maps'}), this.fields));
    section.setAttribute('aria-label', 'Photon maps');
    find('#tools').before(section);
  }

  ///   list   of {name, help, value, words}
  show(list) {
    this.fields.replaceChildren(...list.map(({name, help, value, words}) => {
      const input = words ? element('select', {}, ...words.map((word) => element('option', {textContent: word})))
                          : element('input', {type: 'number', step: 'any', min: 0});
      input.id = `setting-${name}`;
      input.value = value;
      input.addEventListener('change', () => {
        if (input.value !== '') this.live.post('settings', {[name]: words ? input.value : input.valueAsNumber});
      });
      return element('div', {className: 'entry'}, element('label', {textContent: name.replaceAll('_', ' '),
                                                                    title: help, htmlFor: input.id}), input);
    }));
  }
}
