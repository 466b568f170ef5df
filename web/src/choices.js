// What the person chose: edits of the plan, and options. As a request of a repair.

export class Choices {
  constructor() {
    this.remedies = new Map(); // by code, for all elements of the kind
    this.elements = new Map(); // by code: by number, { remedy, method }
    this.takesBest = false;
    this.share = 1; // of the triangles
    this.levels = 1; // results, each with half the triangles of the one before
  }

  // Those of a request.
  static of({ plan, require, ratio, targets }) {
    const choices = new Choices();
    choices.takesBest = require === "best_effort";
    choices.share = targets?.[0]?.ratio ?? ratio ?? 1;
    choices.levels = targets?.length ?? 1;
    for (const { code, remedy, elements } of plan?.findings ?? []) {
      if (remedy) choices.setRemedy(code, remedy);
      for (const { number, ...own } of elements) choices.setElement(code, number, own);
    }
    return choices;
  }

  setRemedy(code, remedy) {
    this.remedies.set(code, remedy);
  }

  // `change`: a remedy or a method; an empty one is as for all.
  setElement(code, number, change) {
    const of = this.elements.get(code) ?? new Map();
    of.set(number, { ...of.get(number), ...change });
    this.elements.set(code, of);
  }

  element(code, number) {
    return this.elements.get(code)?.get(number) ?? {};
  }

  // The parts of the plan that differ from what was proposed; null: none.
  plan(proposed) {
    const findings = proposed.findings.flatMap((finding) => {
      const { code } = finding;
      const remedy = this.remedies.get(code) ?? finding.remedy;
      const chosen = [...(this.elements.get(code) ?? [])].filter(([, { remedy: own, method }]) => own || method);
      if (remedy === finding.remedy && chosen.length === 0) return [];
      const elements = chosen.map(([number, { remedy: own, method }]) => ({ number, remedy: own || remedyOf(finding, number, remedy), ...(method ? { method } : {}) }));
      // Without a remedy, elements that are not named stay as proposed, each its own.
      return [{ code, ...(remedy === finding.remedy ? {} : { remedy }), elements }];
    });
    return findings.length ? { input_sha256: proposed.input_sha256, findings } : null;
  }

  // Members of a request.
  options(proposed) {
    const plan = proposed && this.plan(proposed);
    return {
      ...(plan ? { plan } : {}),
      ...(this.takesBest ? { require: "best_effort" } : {}),
      ...this.simplification(),
    };
  }

  simplification() {
    if (this.levels > 1) return { targets: Array.from({ length: this.levels }, (_, level) => ({ ratio: this.share / 2 ** level })) };
    return this.share < 1 ? { ratio: this.share } : {};
  }
}

const remedyOf = (finding, number, remedy) =>
  (remedy === finding.remedy ? finding.elements.find((element) => element.number === number)?.remedy : null) ?? remedy;
