// The sentences of the page: what a run found, and what it will do.
"use strict";

const counted = (n, noun) => `${n.toLocaleString("en")} ${noun}${n === 1 ? "" : "s"}`;

/** The bad verdicts about pictures. With the other ones, a case has no picture to judge. */
const WRONG = new Set(["fail", "required-by-cts", "disputed", "flaky"]);

/** The seconds per case where nothing else is known: `quick` in Chromium with SwiftShader, on two cores. */
const PACE = 0.009;

/** The numbers of outcomes, from the view of somebody who asks whether the device is right. */
class Tally {
  /** Cases that were drawn, without selftests that must fail. */
  drawn = 0;
  wrong = 0;
  /** Wrong ones that a finding explains. */
  known = 0;
  /** Cases without a picture although the device should draw them. */
  broken = 0;
  imprecise = 0;
  /** Cases whose pictures have no value that could be judged. */
  open = 0;
  lacking = 0;
  selftests = 0;

  add({ verdict, unexpected, bad, due }) {
    if (verdict === "not-supported" || verdict === "skipped") {
      this.lacking += 1;
    } else if (due && bad && !unexpected) {
      this.selftests += 1;
    } else if (bad && !WRONG.has(verdict)) {
      this.broken += 1;
    } else {
      this.drawn += 1;
      this.wrong += bad || unexpected ? 1 : 0;
      this.known += bad && !unexpected ? 1 : 0;
      this.imprecise += verdict === "imprecise" ? 1 : 0;
      this.open += verdict === "open" ? 1 : 0;
    }
  }

  /** Returns `good`, `known`, `bad`, or nothing if no case was drawn. */
  get kind() {
    const { drawn, wrong, known, broken } = this;
    if (broken > 0 || wrong > known) return "bad";
    if (wrong > 0) return "known";
    return drawn > 0 ? "good" : "";
  }

  /** Returns what follows the number of wrong cases. */
  get reasons() {
    const { wrong, known, broken } = this;
    const some = known === 0 ? "" : known === wrong ? ", all because of known bugs" : `, ${known} of them because of known bugs`;
    return `${some}${broken > 0 ? `; ${broken.toLocaleString("en")} more have no picture` : ""}`;
  }
}

/** Returns the sentence about a run. */
function sentence(run, tally) {
  const { opened, running, complete, done } = run;
  const { drawn, wrong, broken } = tally;
  const cases = counted(opened.cases.length, "case");
  if (opened.timed) {
    return complete ? `Measured: ${cases}.` : running ? "Measuring…" : `Stopped after ${done} of ${cases}.`;
  }
  if (running) {
    return `Drawing: ${wrong.toLocaleString("en")} wrong so far${tally.reasons}`;
  }
  if (!complete) {
    return `Stopped after ${done.toLocaleString("en")} of ${cases}: ${wrong.toLocaleString("en")} wrong so far${tally.reasons}.`;
  }
  const subject = opened.software ? "This browser's software renderer" : "Your GPU";
  if (drawn + broken === 0) {
    return `${subject} can draw none of these cases.`;
  }
  if (wrong + broken === 0) {
    return `${subject} draws per-fragment operations correctly: ${counted(drawn, "case")}, 0 wrong.`;
  }
  return `${subject} draws ${wrong.toLocaleString("en")} of ${counted(drawn, "case")} wrong${tally.reasons}.`;
}

/** Returns what else matters at once: the cases that this device cannot draw. */
const lacks = ({ lacking }) =>
  lacking === 0 ? "" : `${counted(lacking, "more case")} ${lacking === 1 ? "needs" : "need"} features that this device or WebGPU lacks.`;

/** Returns what else there is to say about a run. */
function remarks({ opened }, { imprecise, open, selftests }) {
  const texts = [
    imprecise > 0 && `${imprecise.toLocaleString("en")} ${imprecise === 1 ? "case is" : "cases are"} less exact than 32-bit arithmetic, which the specification allows.`,
    open > 0 && `${counted(open, "case")} could not be judged.`,
    selftests > 0 && `${counted(selftests, "selftest")} with a planted mistake failed, as they must.`,
    opened.measured > 0 && `${counted(opened.measured, "case")} that only measure time or quality are left out.`,
  ];
  return texts.filter(Boolean).join(" ");
}

/** Returns a duration in words. */
function duration(seconds) {
  return seconds < 90 ? `${Math.max(1, Math.ceil(seconds))} s` : `${Math.ceil(seconds / 60)} min`;
}

/** Returns how long cases take, and from what that is known. */
function expectation(cases, pace) {
  const known = pace === null
    ? "a first guess: two cores without a GPU need that long"
    : "as fast as the last run in this browser";
  return `about ${duration(cases * (pace ?? PACE))} (${known})`;
}

/** What to do without WebGPU, by a word of the browsers' descriptions of themselves. The first that fits counts. */
const REMEDIES = [
  [/Firefox\//, "Firefox has WebGPU from version 141 on Windows and 145 on macOS. Elsewhere, set dom.webgpu.enabled to true in about:config."],
  [/Chrom(e|ium)\//, "Chrome and Edge have WebGPU from version 113, on Android from 121. If Settings, System switches graphics acceleration off, switch it on. On Linux, also switch on chrome://flags/#enable-unsafe-webgpu and chrome://flags/#enable-vulkan. chrome://gpu says what is still missing."],
  [/Safari\//, "Safari has WebGPU from version 26."],
];

/** Returns what to do without WebGPU, for this browser first. */
function remedies() {
  const own = REMEDIES.findIndex(([words]) => words.test(navigator.userAgent));
  const insecure = isSecureContext ? [] : ["Open this page by https, or from this machine at http://localhost."];
  const texts = REMEDIES.map(([, text]) => text);
  const first = own < 0 ? [] : texts.splice(own, 1);
  return insecure.length > 0 ? insecure : [...first, ...texts];
}
