// Runs the engine of a page: node run.mjs ENGINE CORE ASKED, where ASKED has the data of the page and jobs.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [engine, core, asked] = process.argv.slice(2);
const { Core, Session, evaluated, measures, asPython, asToml } = await import(pathToFileURL(engine));
const { data, jobs } = JSON.parse(readFileSync(asked, "utf8"));
const session = new Session(data, await Core.of(readFileSync(core)));
const made = jobs.map((job) => {
  session.reset();
  Object.entries(job.knots ?? {}).forEach(([i, knots]) => (session.knots[i] = knots));
  Object.entries(job.values ?? {}).forEach(([i, value]) => (session.values[i] = value));
  const run = session.run(job.times ? { times: job.times } : { steps: 1 });
  const signals = (job.signals ?? []).map((name) => [name, [...evaluated(data.signals[name].form, run)]]);
  return {
    refusal: session.refusal(),
    status: run.status,
    reached: run.reached,
    count: run.count,
    events: run.events.map((event) => [...event]),
    signals: Object.fromEntries(signals),
    ...(job.measures ? { measures: measures(data, session.run({ steps: job.measures })) } : {}),
    ...(job.copies ? { python: asPython(session), toml: asToml(session) } : {}),
  };
});
process.stdout.write(JSON.stringify(made));
