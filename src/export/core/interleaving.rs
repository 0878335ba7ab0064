//! Proof by exhaustion that the insertion chain needs no interlock: all interleavings of the memory operations of two
//! and three threads.
//!
//! A thread is `nmt_core_insert` of insert.wgsl cut at its memory operations: plain loads and atomic maxima. A load may
//! return anything that its slot has ever held, since relaxed loads of other slots are not ordered among one another;
//! an atomic maximum sees the newest value.

use crate::features::core::code::{CodeLayout, Codes, CoreFragment, EMPTY, Slot};
use std::collections::{BTreeSet, HashSet};

/// The next memory operation of a thread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Step {
    /// Is the fragment's heavy code greater than the last slot?
    LoadLast { code: u32 },
    /// Is the code greater than what the slot holds?
    Load { place: usize, code: u32 },
    /// The slot keeps the greater.
    Max { place: usize, code: u32 },
    /// What a chain without atomics would do: the slot is read, and written later.
    Write { place: usize, old: u32, code: u32 },
    /// The fragment is in the core, or in the tail.
    Done,
}

/// A thread: its next operation, and the fragments that it has yet to insert.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
struct Thread {
    step: Step,
    waiting: Vec<CoreFragment>,
}

/// Everything: what each slot has held, the newest last, and all threads.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
struct State {
    slots: Vec<Vec<u32>>,
    threads: Vec<Thread>,
}

/// How the chain is written: as exported, or wrong in a way that must be found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Chain {
    Exported,
    /// Slots are read and written in two steps.
    NotAtomic,
    /// A fragment that is lighter than the first heavy one gives up.
    LooksAtFirstHeavy,
    /// The loser of an atomic step is forgotten.
    ForgetsLosers,
}

struct Explorer {
    codes: Codes,
    heavy: usize,
    chain: Chain,
}

impl Explorer {
    /// The operation with which a code arrives at a place of the chain.
    fn arrive(&self, place: usize, code: u32) -> Step {
        match place {
            _ if code == EMPTY || place >= self.heavy + 2 => Step::Done,
            2 => Step::LoadLast { code },
            _ => Step::Load { place, code },
        }
    }

    /// What a slot hands on, in the code of the next.
    fn pass_on(&self, place: usize, code: u32) -> Step {
        let Some(fragment) = self.codes.decode(Slot::at(place), code) else {
            return Step::Done;
        };
        let code = self.codes.encode(Slot::at(place + 1), fragment);
        match place + 1 {
            next if next >= self.heavy + 2 => Step::Done,
            // Only the first heavy slot is preceded by a look at the last.
            2 => self.arrive(2, code),
            next => Step::Load { place: next, code },
        }
    }

    /// A thread whose fragment has left the chain takes its next one.
    fn next_fragment(&self, thread: &mut Thread) {
        while thread.step == Step::Done && !thread.waiting.is_empty() {
            let fragment = thread.waiting.remove(0);
            if fragment.absorbance_step > 0 {
                thread.step = self.arrive(0, self.codes.encode(Slot::Nearest, fragment));
            }
        }
    }

    /// All states that one operation of one thread leads to.
    fn successors(&self, state: &State) -> Vec<State> {
        let mut out = Vec::new();
        for i in 0..state.threads.len() {
            let mut go = |slots: Vec<Vec<u32>>, step: Step| {
                let mut next = State {
                    slots,
                    threads: state.threads.clone(),
                };
                next.threads[i].step = step;
                self.next_fragment(&mut next.threads[i]);
                out.push(next);
            };
            match state.threads[i].step {
                Step::Done => {}
                Step::LoadLast { code } => {
                    let place = if self.chain == Chain::LooksAtFirstHeavy {
                        2
                    } else {
                        self.heavy + 1
                    };
                    for &held in &state.slots[place] {
                        let step = if held >= code {
                            Step::Done
                        } else {
                            Step::Load { place: 2, code }
                        };
                        go(state.slots.clone(), step);
                    }
                }
                Step::Load { place, code } => {
                    for &held in &state.slots[place] {
                        let step = match self.chain {
                            _ if held >= code => self.pass_on(place, code),
                            Chain::NotAtomic => Step::Write { place, old: held, code },
                            _ => Step::Max { place, code },
                        };
                        go(state.slots.clone(), step);
                    }
                }
                Step::Max { place, code } => {
                    let old = *state.slots[place].last().unwrap();
                    let mut slots = state.slots.clone();
                    if code > old {
                        slots[place].push(code);
                    }
                    let handed_on = if self.chain == Chain::ForgetsLosers {
                        EMPTY
                    } else {
                        old.min(code)
                    };
                    go(slots, self.pass_on(place, handed_on));
                }
                Step::Write { place, old, code } => {
                    let mut slots = state.slots.clone();
                    slots[place].push(old.max(code));
                    go(slots, self.pass_on(place, old.min(code)));
                }
            }
        }
        out
    }

    /// Contents of the slots once all threads are done, over all interleavings; and the number of states.
    fn outcomes(&self, threads: &[Vec<CoreFragment>]) -> (BTreeSet<Vec<u32>>, usize) {
        let threads = threads.iter().map(|fragments| {
            let mut thread = Thread {
                step: Step::Done,
                waiting: fragments.clone(),
            };
            self.next_fragment(&mut thread);
            thread
        });
        let start = State {
            slots: vec![vec![EMPTY]; self.heavy + 2],
            threads: threads.collect(),
        };
        let (mut seen, mut open) = (HashSet::from([start.clone()]), vec![start]);
        let mut outcomes = BTreeSet::new();
        while let Some(state) = open.pop() {
            let next = self.successors(&state);
            if next.is_empty() {
                outcomes.insert(state.slots.iter().map(|held| *held.last().unwrap()).collect());
            }
            open.extend(next.into_iter().filter(|s| seen.insert(s.clone())));
        }
        (outcomes, seen.len())
    }
}

fn codes() -> Codes {
    let layout = CodeLayout {
        depth_bits: 16,
        octave_bits: 11,
        key_exponent: 6.0,
    };
    layout.codes(2.5, 5.6)
}

/// All lists of `n` fragments of these, doubles included.
fn lists(of: &[CoreFragment], n: usize) -> Vec<Vec<CoreFragment>> {
    if n == 0 {
        return vec![vec![]];
    }
    let shorter = lists(of, n - 1);
    shorter
        .iter()
        .flat_map(|list| of.iter().map(move |&f| [&list[..], &[f]].concat()))
        .collect()
}

/// Runs all splits of a list over threads, and counts those whose outcome is not the one of inserting one after
/// another.
fn wrong_outcomes(chain: Chain, heavy: usize, cases: &[Vec<Vec<CoreFragment>>]) -> (usize, usize) {
    let explorer = Explorer {
        codes: codes(),
        heavy,
        chain,
    };
    let (mut wrong, mut states) = (0, 0);
    for threads in cases {
        let mut alone = vec![EMPTY; heavy + 2];
        for &fragment in threads.iter().flatten() {
            explorer.codes.insert(&mut alone, fragment);
        }
        let (outcomes, seen) = explorer.outcomes(threads);
        wrong += usize::from(outcomes != BTreeSet::from([alone]));
        states += seen;
    }
    (wrong, states)
}

/// Three depths, one of them with two absorbances, and one fragment that absorbs nothing; so that ties, doubles and
/// changing ends all occur.
fn few() -> [CoreFragment; 4] {
    [(100, 3000), (100, 9000), (40_000, 5000), (65_000, 20_000)].map(|(depth_step, absorbance_step)| CoreFragment {
        depth_step,
        absorbance_step,
    })
}

/// Two threads of two fragments each, all 256 choices of them, K of 0 to 2: every interleaving ends with what one
/// thread would leave. Two threads of one and three, three threads of one each likewise. Controls: slots that are not
/// atomic, a look at the wrong slot, forgotten losers are all found.
#[test]
fn every_interleaving_leaves_the_same_core() {
    let mut two_and_two = Vec::new();
    for list in lists(&few(), 4) {
        two_and_two.push(vec![list[..2].to_vec(), list[2..].to_vec()]);
    }
    let mut three_threads = Vec::new();
    let all = [
        &few()[..],
        &[CoreFragment {
            depth_step: 7,
            absorbance_step: 0,
        }],
    ]
    .concat();
    for list in lists(&all, 3) {
        three_threads.push(list.iter().map(|&f| vec![f]).collect::<Vec<_>>());
    }
    for heavy in 0..=2 {
        for (name, cases) in [("two threads", &two_and_two), ("three threads", &three_threads)] {
            let (wrong, states) = wrong_outcomes(Chain::Exported, heavy, cases);
            println!("{name}, {heavy} heavy: {} cases, {states} states", cases.len());
            assert_eq!(wrong, 0, "{name}, {heavy} heavy");
            assert!(states > 10 * cases.len());
        }
    }
    for chain in [Chain::NotAtomic, Chain::ForgetsLosers] {
        let (wrong, _) = wrong_outcomes(chain, 1, &two_and_two);
        assert!(wrong > 50, "{chain:?}: {wrong}");
    }
    let (wrong, _) = wrong_outcomes(Chain::LooksAtFirstHeavy, 2, &two_and_two);
    assert!(wrong > 5, "{wrong}");
}

/// Two threads race for a core that is already full, one fragment each and two heavy slots: all choices of what is
/// there before and of who comes.
#[test]
fn races_for_a_full_core_end_alike() {
    let explorer = Explorer {
        codes: codes(),
        heavy: 2,
        chain: Chain::Exported,
    };
    let all = [
        (10, 500),
        (200, 3000),
        (30_000, 9000),
        (30_000, 2000),
        (50_000, 4000),
        (65_535, 100),
    ];
    let all = all.map(|(depth_step, absorbance_step)| CoreFragment {
        depth_step,
        absorbance_step,
    });
    for before in lists(&all, 4).into_iter().step_by(7) {
        for race in lists(&all, 2) {
            let mut start = vec![EMPTY; 4];
            for &f in &before {
                explorer.codes.insert(&mut start, f);
            }
            let mut expected = start.clone();
            for &f in &race {
                explorer.codes.insert(&mut expected, f);
            }
            let threads = race.iter().map(|&f| Thread {
                step: explorer.arrive(0, explorer.codes.encode(Slot::Nearest, f)),
                waiting: vec![],
            });
            let start = State {
                slots: start.into_iter().map(|code| vec![code]).collect(),
                threads: threads.collect(),
            };
            let (mut seen, mut open) = (HashSet::from([start.clone()]), vec![start]);
            while let Some(state) = open.pop() {
                let next = explorer.successors(&state);
                if next.is_empty() {
                    let left: Vec<u32> = state.slots.iter().map(|held| *held.last().unwrap()).collect();
                    assert_eq!(left, expected, "{before:?} {race:?}");
                }
                open.extend(next.into_iter().filter(|s| seen.insert(s.clone())));
            }
        }
    }
}
