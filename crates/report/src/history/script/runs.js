// Runs, timelines and their drivers.
const EVENTS = [["✗ broken", "f"], ["⇄ flaky", "o"], ["✓ fixed", "p"], ["+ appeared", "n"], ["− gone", "u"]];
const GONE = EVENTS.length - 1;
let all = null;

function unpacked(data) {
  if (!data) return null;
  const runs = data.runs.map(([id, kind, started, released, etalon, commit, machine, profile, missing, labels, digest], place) => ({
    id, kind, started, released, etalon, commit, machine: data.machines[machine], profile, missing, labels, digest, place,
    day: released || started.slice(0, 10),
  }));
  const lines = data.timelines.map(([name, of], number) => ({
    name, number,
    runs: of.map(([place, isWhole, driver, records]) => {
      const [version, text, device] = data.drivers[driver];
      return { run: runs[place], whole: isWhole === 1, version, driver: text, device, records };
    }),
  }));
  const looks = data.looks.map(([text, colour, reason, inferred, unexpected]) => ({
    text, colour, reason, inferred: inferred === 1, unexpected: unexpected === 1,
  }));
  return { runs, lines, looks };
}

async function runs() {
  all = all || unpacked(await need("runs"));
  return all;
}

function runLink(one) {
  return make("a", { href: "#run=" + one.run.id }, one.run.day);
}

// A run of a timeline: its day, its number, and the driver's version at that time.
function told(one) {
  return [runLink(one), " ", make("small", {}, "run " + one.run.id + ", " + (one.version || "no version"))];
}

// What changed between two runs of a timeline.
function range(before, after) {
  const same = (a, b, noun) => a === b ? "same " + noun : noun + " " + (a || "unknown") + " → " + (b || "unknown");
  const short = commit => commit.slice(0, 12);
  const parts = [same(before.version, after.version, "driver version")];
  if (before.driver !== after.driver && before.version === after.version) parts.push(same(before.driver, after.driver, "driver"));
  parts.push(same(short(before.run.commit), short(after.run.commit), "suite commit"));
  if (before.run.machine !== after.run.machine) parts.push(same(before.run.machine, after.run.machine, "machine"));
  return parts.join("; ");
}

