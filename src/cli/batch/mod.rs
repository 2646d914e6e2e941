//! `rara batch`: many commands as one, over any number of workers.

mod jobs;
mod part;
mod state;

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use clap::Args;
use rara::Headless;
use serde_json::json;

use super::failure::Failure;
use super::kept::SessionCache;
use super::output::{self, ProgressLine, counted, counted_are, say};
use super::pictures::{Order, Plan, RunPart};
use super::report::FrameRecord;
use super::times;
use super::{Command, program};
use jobs::Job;
pub(super) use jobs::save as save_job;
use state::{Claim, State, StateRecord, Worker, stamp};

/// Draw the pictures of many commands, and share them among workers
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara batch jobs.json
  rara batch jobs.json --part 3/10
  rara batch jobs.json --status
  rara render scene.ply -o view_{}.png --cameras cameras.json --view all --save-job jobs.json

A job is a command, written as JSON: {\"scene\": \"a.ply\", \"output\": \"a.png\", \"clip\": [\"plane:z=40%\"], \"size\": \
\"512x512\"}. \"scene\" is a file or a list of layers. Every other key is a flag of rara render, or of rara sweep if the \
job has \"command\": \"sweep\". The value true stands for a flag that takes no value. A file contains one job, several \
jobs one after the other, a list of jobs, or {\"jobs\": [...]}; keys next to \"jobs\" apply to all jobs of the list. Paths \
are relative to the working directory.

\"for\": {\"z\": \"0..100:101\", \"scan\": [\"a\", \"b\"]} makes one job for each combination of its values. 0..9 stands \
for the whole numbers from 0 to 9, and 0..1:11 for 11 numbers from 0 to 1 in equal steps. In the other keys of the job, \
${z} stands for the value of z, and ${z:03} for the value with leading zeros. \"zip\": {\"z\": \"0..100:5\", \"view\": \
\"0..4\"} makes five jobs: z and view take \
their first values in the first job, their second values in the second one, and so on.

Workers record finished pictures in the folder of --state and do not draw them again. Workers on several machines may \
share this folder. In an array job of Slurm or SGE, each task draws its part. Tasks of Kubernetes and PBS do so too if \
RARA_PARTS is set to the number of tasks. A worker that is killed leaves no partial pictures: start it again to draw the \
rest. The exit status is 1 if a picture is missing.")]
pub(super) struct Batch {
    /// Files of jobs; - is standard input
    #[arg(value_name = "JOBS", required = true)]
    files: Vec<PathBuf>,
    /// Divide the pictures into N parts, and draw only part K, from 1 to N
    ///
    /// All parts take about equally long. The same K and N always give the same part.
    #[arg(long, value_name = "K/N", alias = "shard")]
    part: Option<RunPart>,
    /// Folder that records finished pictures [default: the first file's name plus .done]
    ///
    /// Jobs from standard input have no file, so that they need this flag.
    #[arg(long, value_name = "DIR")]
    state: Option<PathBuf>,
    /// Redraw pictures whose job has changed, or that another version or driver drew
    #[arg(long)]
    redraw: bool,
    /// Print which pictures are done and which are missing, and draw nothing
    #[arg(long)]
    status: bool,
    /// Print how long the finished pictures took, and draw nothing
    #[arg(long, conflicts_with = "status")]
    report: bool,
    /// Print JSON: the result of --status or --report, or a line of statistics per picture
    #[arg(long)]
    json: bool,
}

struct JobPlan {
    job: Job,
    /// A short text stands for its own.
    stamp: String,
    plan: Plan,
    /// The numbers of the pictures that are to be drawn here, and where they are in the plan.
    wanted: BTreeMap<usize, usize>,
}

impl Batch {
    pub(super) fn run(self) -> Result<(), Failure> {
        let folder = self.folder()?;
        let mut planned = self.planned()?;
        let ours = self.ours(&planned)?;
        let state = State::read(&folder)?;
        if state.unread > 0 {
            say(format_args!(
                "note: {}: {} and left out",
                folder.display(),
                match state.unread {
                    1 => "1 line is not an entry".into(),
                    _ => format!("{} not entries", counted_are(state.unread as u64, "line")),
                }
            ));
        }
        if self.status {
            return self.say_status(&planned, &ours, &state);
        }
        if self.report {
            return self.say_report(&planned, &ours, &state);
        }
        let (done, stale) = done(&planned, &ours, &state);
        for ((job, index), done) in ours.iter().zip(done) {
            if done == PictureState::Not || (self.redraw && done == PictureState::Otherwise) {
                let one = &mut planned[*job];
                let (number, _) = one.plan.pictures[*index];
                one.wanted.insert(number, *index);
            }
        }
        if stale > 0 {
            let drawn = match self.redraw {
                true => "drawn again",
                false if stale == 1 => "is kept: --redraw draws it again",
                false => "are kept: --redraw draws them again",
            };
            say(format_args!(
                "note: {} drawn by another job, version or driver, and {drawn}",
                match stale {
                    1 => "1 picture was".into(),
                    _ => format!("{} were", counted(stale as u64, "picture")),
                }
            ));
        }
        draw(&planned, &folder, &state, self.json)?;
        let now = State::read(&folder)?;
        let missing = missing(&planned, &ours, &now);
        say(format_args!(
            "{} of {} there",
            ours.len() - missing.len(),
            counted_are(ours.len() as u64, "picture")
        ));
        refuse(&missing)
    }

    /// The folder in which it is noted what is done.
    fn folder(&self) -> Result<PathBuf, Failure> {
        match (&self.state, self.files.iter().find(|file| *file != Path::new("-"))) {
            (Some(folder), _) => Ok(folder.clone()),
            (None, Some(file)) => {
                let mut name = file.clone().into_os_string();
                name.push(".done");
                Ok(name.into())
            }
            (None, None) => Err(Failure::Usage(
                "jobs from standard input have no file next to which their state could be kept: give --state a folder".into(),
            )),
        }
    }

    /// All jobs, those of one scene one after the other.
    fn planned(&self) -> Result<Vec<JobPlan>, Failure> {
        let mut planned: Vec<JobPlan> = Vec::new();
        let mut names: HashMap<String, String> = HashMap::new();
        for file in &self.files {
            for job in jobs::read(file)? {
                let about = |failure: Failure| failure.in_job(&job.name);
                let plan = match job.command().map_err(about)? {
                    Command::Render(command) => command.plan(),
                    Command::Sweep(command) => command.plan(),
                    _ => unreachable!("a job has one of these commands"),
                }
                .map_err(about)?;
                for (_, name) in &plan.pictures {
                    if name == output::STANDARD {
                        return Err(Failure::Usage(format!(
                            "{}: {name} is standard output, and a batch writes its pictures to files: name one",
                            job.name
                        )));
                    }
                    if let Some(other) = names.insert(name.clone(), job.name.clone()) {
                        return Err(Failure::Usage(format!(
                            "{}: {name} is a picture of {other} too: give them names that differ",
                            job.name
                        )));
                    }
                }
                planned.push(JobPlan {
                    stamp: stamp(&format!("{:?}", job.words)),
                    job,
                    plan,
                    wanted: BTreeMap::new(),
                });
            }
        }
        let mut first: HashMap<String, usize> = HashMap::new();
        for one in &planned {
            let next = first.len();
            first.entry(one.plan.scene.clone()).or_insert(next);
        }
        planned.sort_by_key(|one| first[&one.plan.scene]);
        Ok(planned)
    }

    /// The pictures of this worker's part: the numbers of a job and of its picture.
    fn ours(&self, planned: &[JobPlan]) -> Result<Vec<(usize, usize)>, Failure> {
        let looks = self.status || self.report;
        let part = match self.part {
            None if !looks => part::of_scheduler(|name| std::env::var(name).ok())?,
            given => given,
        };
        let all = planned
            .iter()
            .enumerate()
            .flat_map(|(job, one)| (0..one.plan.pictures.len()).map(move |index| (job, index)));
        let all: Vec<_> = all.collect();
        let Some(part) = part else {
            return Ok(all);
        };
        let scene = |job: usize| &planned[job].plan.scene;
        let mut scenes = 0;
        let mut last = 0;
        let work: Vec<_> = all
            .iter()
            .map(|&(job, _)| {
                scenes += usize::from(scene(job) != scene(last));
                last = job;
                (scenes, planned[job].plan.work)
            })
            .collect();
        let is_ours = part::has(part, &work).into_iter();
        let ours = all.into_iter().zip(is_ours).filter(|(_, is_ours)| *is_ours);
        let ours: Vec<_> = ours.map(|(picture, _)| picture).collect();
        say(format_args!(
            "part {part}: {} of {}",
            ours.len(),
            counted(work.len() as u64, "picture")
        ));
        Ok(ours)
    }

    fn say_status(
        &self,
        planned: &[JobPlan],
        ours: &[(usize, usize)],
        state: &State,
    ) -> Result<(), Failure> {
        let missing = missing(planned, ours, state);
        let (_, old) = done(planned, ours, state);
        let there = ours.len() - missing.len();
        if self.json {
            output::json(&json!({
                "pictures": ours.len(), "there": there, "of_another": old, "missing": missing,
            }))?;
        } else {
            output::answer(&format!(
                "pictures    {}\nfinished    {there}, {old} of them by another job, version or driver\nmissing     {}",
                ours.len(),
                missing.len()
            ))?;
        }
        refuse(&missing)
    }

    fn say_report(
        &self,
        planned: &[JobPlan],
        ours: &[(usize, usize)],
        state: &State,
    ) -> Result<(), Failure> {
        let name = |(job, index): &(usize, usize)| &planned[*job].plan.pictures[*index].1;
        let entries: Vec<&StateRecord> = ours
            .iter()
            .filter_map(|picture| state.entries.get(name(picture)))
            .collect();
        let mut workers: BTreeMap<&str, (usize, f64)> = BTreeMap::new();
        for entry in &entries {
            let (count, seconds) = workers.entry(&entry.worker).or_default();
            *count += 1;
            *seconds += entry.seconds;
        }
        let ms = |entry: &&StateRecord| entry.frame["wall_ms"].as_f64().unwrap_or(0.0);
        let median = super::combine::Combine::Median.apply(entries.iter().map(ms).collect());
        let seconds = times::sum(entries.iter().map(|entry| entry.seconds));
        if self.json {
            let workers = workers.iter().map(|(name, (count, seconds))| {
                json!({ "worker": name, "pictures": count, "seconds": seconds })
            });
            let workers: Vec<_> = workers.collect();
            return Ok(output::json(&json!({
                "pictures": entries.len(), "seconds": seconds, "median_wall_ms": median,
                "workers": workers, "entries": entries,
            }))?);
        }
        let mut lines = vec![format!(
            "{} in {seconds:.1} s of work, a frame in {median:.2} ms (median)",
            counted(entries.len() as u64, "picture")
        )];
        lines.extend(workers.iter().map(|(name, (count, seconds))| {
            let pictures = counted(*count as u64, "picture");
            format!("worker {name}: {pictures} in {seconds:.1} s")
        }));
        let mut slowest = entries;
        slowest.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
        let slow = slowest.iter().take(5);
        lines.extend(slow.map(|one| format!("{:.2} s for {}", one.seconds, one.file.display())));
        Ok(output::answer(&lines.join("\n"))?)
    }
}

impl Job {
    fn command(&self) -> Result<Command, Failure> {
        let command = program::command(self.words.iter().cloned())?;
        Ok(command.expect("every job is a command of rara"))
    }
}

/// The driver that would draw the first job, if any picture is to be compared with it.
fn driver(planned: &[JobPlan], state: &State) -> Option<String> {
    let first = planned.first().filter(|_| !state.entries.is_empty())?;
    let headless = Headless::new(&first.plan.device).ok()?;
    Some(headless.driver().to_owned())
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PictureState {
    Not,
    /// It was drawn by another job, version or driver.
    Otherwise,
    /// It would be drawn likewise today.
    Likewise,
}

/// The state of each picture of a part, and how many were drawn otherwise.
fn done(planned: &[JobPlan], ours: &[(usize, usize)], state: &State) -> (Vec<PictureState>, usize) {
    let driver = driver(planned, state);
    let of = |(job, index): &(usize, usize)| {
        let one = &planned[*job];
        let entry = state.entries.get(&one.plan.pictures[*index].1);
        match entry.filter(|entry| entry.is_there()) {
            None => PictureState::Not,
            Some(entry)
                if entry.job == one.stamp
                    && entry.version == env!("CARGO_PKG_VERSION")
                    // Without a driver any will do.
                    && driver.as_ref().is_none_or(|driver| entry.driver == *driver) =>
            {
                PictureState::Likewise
            }
            Some(_) => PictureState::Otherwise,
        }
    };
    let done: Vec<_> = ours.iter().map(of).collect();
    let stale = done.iter().filter(|one| **one == PictureState::Otherwise);
    let stale = stale.count();
    (done, stale)
}

fn missing<'a>(planned: &'a [JobPlan], ours: &[(usize, usize)], state: &State) -> Vec<&'a str> {
    let name = |(job, index): &(usize, usize)| planned[*job].plan.pictures[*index].1.as_str();
    let entry = |name: &str| state.entries.get(name);
    let is_missing = |name: &&str| !entry(name).is_some_and(StateRecord::is_there);
    ours.iter().map(name).filter(is_missing).collect()
}

fn refuse(missing: &[&str]) -> Result<(), Failure> {
    /// The number of names that fit on a line.
    const NAMED: usize = 5;
    if missing.is_empty() {
        return Ok(());
    }
    let more = match missing.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let named = missing.iter().take(NAMED).copied().collect::<Vec<_>>();
    Err(rara::Error::Invalid(format!(
        "{} missing: {}{more}; correct what failed, and run the same command again",
        counted_are(missing.len() as u64, "picture"),
        named.join(", ")
    ))
    .into())
}

/// Draws the pictures that are wanted, job by job. A job that fails is said, and the others are drawn.
fn draw(planned: &[JobPlan], folder: &Path, state: &State, prints: bool) -> Result<(), Failure> {
    let left: Vec<&JobPlan> = planned
        .iter()
        .filter(|one| !one.wanted.is_empty())
        .collect();
    if left.is_empty() {
        return Ok(());
    }
    let worker = Worker::new(folder)?;
    let work = |one: &&JobPlan| one.plan.work * one.wanted.len() as f64;
    let run = Run {
        worker: &worker,
        state,
        prints,
        progress: Mutex::new(Pace {
            bar: ProgressLine::new("drawing"),
            begin: Instant::now(),
            last: Instant::now(),
            done: 0.0,
            all: times::sum(left.iter().map(work)),
        }),
    };
    let mut kept = SessionCache::wanted();
    for one in left {
        let order = OneJob {
            run: &run,
            planned: one,
            claims: Mutex::default(),
            driver: Mutex::default(),
        };
        let drawn = match one.job.command()? {
            Command::Render(command) => command.run_in(&mut kept, Some(&order)),
            Command::Sweep(command) => command.run_in(&mut kept, Some(&order)),
            _ => unreachable!("a job has one of these commands"),
        };
        if let Err(failure) = drawn {
            let failure = failure.in_job(&one.job.name);
            failure.details().for_each(output::complain);
            output::complain(&failure);
        }
    }
    Ok(kept.close()?)
}

struct Run<'a> {
    worker: &'a Worker,
    state: &'a State,
    prints: bool,
    progress: Mutex<Pace>,
}

struct Pace {
    bar: ProgressLine,
    begin: Instant,
    last: Instant,
    /// Work that is done, and all of it.
    done: f64,
    all: f64,
}

impl Pace {
    /// Some work is done. Returns the seconds since the last time.
    fn step(&mut self, work: f64) -> f64 {
        self.done += work;
        let share = (self.done / self.all).clamp(1e-9, 1.0);
        let left = self.begin.elapsed().as_secs_f64() * (1.0 / share - 1.0);
        self.bar.describe(&format!(
            "drawing, about {:.0} min left",
            (left / 60.0).ceil()
        ));
        self.bar.update((1e3 * share) as u64, 1000);
        let seconds = self.last.elapsed().as_secs_f64();
        self.last = Instant::now();
        seconds
    }
}

/// A run asks this of one of its jobs.
struct OneJob<'a> {
    run: &'a Run<'a>,
    planned: &'a JobPlan,
    /// Each picture that is being drawn has one.
    claims: Mutex<HashMap<usize, Claim>>,
    driver: Mutex<String>,
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

impl OneJob<'_> {
    fn name(&self, number: usize) -> &str {
        let index = self.planned.wanted[&number];
        &self.planned.plan.pictures[index].1
    }
}

impl Order for OneJob<'_> {
    fn wants(&self, number: usize) -> bool {
        self.planned.wanted.contains_key(&number)
    }

    fn begin(&self, number: usize, file: Option<&Path>) -> Result<bool, Failure> {
        let name = self.name(number);
        let entry = self.run.state.entries.get(name);
        let at = entry.map_or(0.0, |entry| entry.at);
        let claim = self.run.worker.claim((name, at), file)?;
        let is_free = claim.is_some();
        lock(&self.claims).extend(claim.map(|claim| (number, claim)));
        Ok(is_free)
    }

    fn opened(&self, driver: &str) {
        *lock(&self.driver) = driver.to_owned();
    }

    fn end(&self, number: usize, file: &Path, frame: &FrameRecord) -> Result<(), Failure> {
        let seconds = lock(&self.run.progress).step(self.planned.plan.work);
        let about = std::fs::metadata(file).map_err(rara::Error::io(file))?;
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        let entry = StateRecord {
            picture: self.name(number).to_owned(),
            file: file.to_owned(),
            bytes: about.len(),
            job: self.planned.stamp.clone(),
            version: env!("CARGO_PKG_VERSION").into(),
            driver: lock(&self.driver).clone(),
            worker: rara_base::files::mark().into(),
            at: since.map_or(0.0, |since| since.as_secs_f64()),
            seconds,
            work: self.planned.plan.work,
            frame: serde_json::to_value(frame).expect("a frame has string keys only"),
        };
        self.run.worker.note(&entry)?;
        if self.run.prints {
            output::json_line(&entry)?;
        }
        let claim = lock(&self.claims).remove(&number);
        claim.map_or(Ok(()), |claim| Ok(claim.release(entry.at)?))
    }
}
