//! The job as a script for Slurm that submits itself: each step is an array of tasks that waits for the step before.

use std::fmt::Write;

use super::{Names, Plan, Step, Tasks, Word, quoted};

const NAMES: Names = Names {
    scene: "$scene",
    results: "$results",
    name: Some("${name}"),
    shard: "${SLURM_ARRAY_TASK_ID}",
    frames: "$from..$through",
};

/// The frames of a task.
const RUN: &str = "    from=$((SLURM_ARRAY_TASK_ID * frames_a_task))
    through=$((from + frames_a_task - 1))
    if ((through > last)); then through=$last; fi
";

/// The beginning of the part that submits all steps; `submit STEP BEFORE OPTIONS...` prints the number of the step's
/// job.
const SUBMIT: &str = "*)
    mkdir -p \"$results/logs\"
    submit() {
        local step=$1 before=$2
        shift 2
        sbatch --parsable --requeue --open-mode=append --kill-on-invalid-dep=yes --job-name=\"$name-$step\" \\
            --output=\"${results//\\%/%%}/logs/$step-%a.txt\" ${before:+--dependency=afterok:$before} \"$@\" \"$0\" \"step:$step\" |
            cut -d ';' -f 1
    }
    before=
";

impl Plan {
    /// The script.
    pub fn script(&self) -> String {
        let steps = self.steps(&NAMES);
        let [scene, results, name] =
            [self.scene.to_string_lossy(), self.results.to_string_lossy(), self.name.as_str().into()]
                .map(|word| quoted(&word));
        let mut out = format!(
            "#!/bin/bash
# Written by nabiki farm. Submits the job:   bash THIS [options of sbatch, such as --partition=render --mem=8G]
# Every machine needs the scene, the files that it names and the results at these places, and nabiki on its path or
# in NABIKI. A task that is killed may run again: files appear when they are whole.
set -euo pipefail
scene={scene}
results={results}
name={name}
last={last}
frames_a_task={frames_a_task}
nabiki=${{NABIKI:-nabiki}}

case \"${{1:-}}\" in
",
            last = self.last,
            frames_a_task = self.frames_a_task,
        );
        for Step { name, tasks, command } in &steps {
            let _ = writeln!(out, "step:{name})");
            if matches!(tasks, Tasks::Frames) {
                out.push_str(RUN);
            }
            let words: Vec<String> = command.iter().map(word).collect();
            let _ = writeln!(out, "    exec \"$nabiki\" {}\n    ;;", words.join(" "));
        }
        out.push_str(SUBMIT);
        for Step { name, tasks, .. } in &steps {
            let array = match tasks {
                Tasks::One => "--array=0".to_owned(),
                Tasks::Shards => format!("--array=1-{}", self.shards),
                Tasks::Frames => format!("--array=0-{}", self.last / self.frames_a_task),
            };
            let _ = write!(
                out,
                "    before=$(submit {name} \"$before\" {array} \"$@\")\n    echo \"{name}: job $before\"\n"
            );
        }
        out.push_str("    ;;\nesac\n");
        out
    }
}

fn word(word: &Word) -> String {
    match word {
        Word::Plain(word) => quoted(word),
        // Only names of variables and text without need of quotes are filled in here.
        Word::Filled(word) => format!("\"{word}\""),
    }
}
