// Search in Chinese: mdBook's index splits texts at blanks, which Chinese does not have. This searches the texts of the index for the
// words that were typed, and shows the surroundings of the first one.
"use strict";

(() => {
    const AROUND = 40;
    const WEIGHTS = { title: 8, breadcrumbs: 2, body: 1 };

    const count = (text, word) => text.toLowerCase().split(word).length - 1;

    // The score of a page: 0 if one of the words is nowhere on it.
    const score = (doc, words) => {
        let sum = 0;
        for (const word of words) {
            const found = Object.entries(WEIGHTS).reduce((all, [key, weight]) => all + weight * count(doc[key] || "", word), 0);
            if (found === 0) {
                return 0;
            }
            sum += found;
        }
        return sum;
    };

    // The text around the first word, with blanks at both sides of it, where mdBook looks for words to mark.
    const surroundings = (body, word) => {
        const at = Math.max(body.toLowerCase().indexOf(word), 0);
        const [from, to] = [Math.max(at - AROUND, 0), at + word.length];
        return `${body.slice(from, at)} ${body.slice(at, to)} ${body.slice(to, to + AROUND)}`;
    };

    window.elasticlunr.Index.prototype.search = function (text) {
        const words = text.toLowerCase().split(/\s+/).filter((word) => word !== "");
        if (words.length === 0) {
            return [];
        }
        return Object.entries(this.documentStore.docs)
            .map(([ref, doc]) => ({ ref, score: score(doc, words), doc }))
            .filter((result) => result.score > 0)
            .sort((a, b) => b.score - a.score)
            .map((result) => ({ ...result, doc: { ...result.doc, body: surroundings(result.doc.body, words[0]) } }));
    };
})();
