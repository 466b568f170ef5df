//! The repair plan: a list of steps that a client can read, and the loop that runs it.

use super::repair_choices::Choices;
use super::step::Step;
use super::stitches::Stitches;
use super::{Action, Contact};
use crate::analysis::{Analysis, DefectCode};
use crate::budget::{Budget, Stopped};
use crate::mesh::{ChosenEdges, Soup, StitchValidity};
use crate::repair::cut::CutOptions;
use crate::repair::duplicates::OppositePairs;
use crate::repair::fill::HoleReport;
use crate::repair::nest::NestOptions;
use crate::repair::noise::Noise;
use crate::repair::pair_sheets::Across;
use crate::repair::polygons::DegenerateFaces;
use crate::repair::snap::SnapOptions;
use crate::repair::unite::Coverage;
use crate::repair::{self, Changes, Draft, Effects};

/// What distinguishes the plans that are tried for one file.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Variant {
    /// What is done about coordinates that are all but zero, first.
    pub(super) noise: Noise,
    /// Coordinates become float32 first.
    pub(super) rounds: bool,
    /// Corners of triangles that all but meet others go to a lattice of so many steps of the print lattice first; 0: none do.
    pub(super) coarse: u32,
    /// How far apart rims are joined where the caller says nothing, in the unit of the file; 0: only where they coincide.
    pub(super) snap_epsilon: f64,
    /// What becomes of opposite duplicates.
    pub(super) opposite: OppositePairs,
    /// Triangles that meet others go first, with this many rings around them.
    pub(super) removes_crossing: Option<u32>,
    /// What becomes of bodies that touch; `None`: nothing.
    pub(super) contact: Option<Contact>,
    /// Open parts get walls, and no hole is filled.
    pub(super) thickens: bool,
    /// Needles and caps go, where that is chosen.
    pub(super) mends_thin_faces: bool,
    /// Rims that face each other across a gap get one patch between them.
    pub(super) bridges: bool,
    /// Gaps between an arc and its chord over which a surface lies are closed.
    pub(super) closes_chordal_gaps: bool,
    /// What is open after holes are filled gets walls.
    pub(super) thickens_rest: bool,
}

/// What bodies are made of that are to be united.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Uniting {
    /// The triangles as they are, copies too: each says what is solid behind it.
    AsDrawn,
    /// What the steps that mend the surface make of them; what is open then is spanned.
    Mended,
    /// The triangles as they are; what is open is spanned.
    Spanned,
    /// As `Mended`, with walls behind open parts.
    Thickened,
    /// As `Spanned`, with walls behind triangles that bound nothing.
    Walled,
    /// All that the triangles of each part enclose, whichever way they turn.
    Enclosed,
    /// As `Enclosed`, with walls behind triangles that bound nothing.
    EnclosedAndWalled,
}

/// Steps of the lattice by which contacts are bored, one time after the other: a body that is taken out can touch what is beside
/// it, and a larger one takes that too.
const LITTLE_BORINGS: [u32; 2] = [16, 64];
const MORE_BORINGS: [u32; 2] = [256, 1024];

/// How often what touches itself is joined or parted, since what is drawn apart there may meet something else.
const PARTINGS: usize = 3;

impl Variant {
    /// The steps that unite bodies which pass through each other.
    pub(super) fn uniting(self, uniting: Uniting, choices: &Choices) -> Vec<Step> {
        let mended = Self { contact: None, ..self };
        let (mut steps, may_be_open) = match uniting {
            Uniting::AsDrawn | Uniting::Enclosed | Uniting::EnclosedAndWalled => {
                (self.welding(choices), false)
            }
            Uniting::Mended => (mended.mending(choices), choices.fills_all_holes()),
            Uniting::Spanned | Uniting::Walled => (self.welding(choices), true),
            Uniting::Thickened => (Self { thickens: true, ..mended }.mending(choices), false),
        };
        steps.push(Step::JoinCopies);
        steps.extend(may_be_open.then_some(Step::SpanRims));
        let wall = Step::Thicken { wall: choices.wall };
        match uniting {
            Uniting::Walled => steps.extend([Step::UniteAndCopyBare, wall]),
            Uniting::Enclosed => steps.extend([Step::SpanOddEdges, Step::Enclose]),
            Uniting::EnclosedAndWalled => {
                steps.extend([Step::SpanOddEdges, Step::EncloseAndCopyBare, wall]);
            }
            Uniting::AsDrawn | Uniting::Mended | Uniting::Spanned | Uniting::Thickened => {}
        }
        steps.push(Step::Unite);
        steps
    }

    /// What may follow where the united bodies are no solid yet: what touches itself is joined or parted, what meets after that or
    /// after rounding is united once more.
    pub(super) fn settling(contact: Contact, choices: &Choices) -> Vec<Vec<Step>> {
        let parting = [Self::parting(contact, choices), vec![Step::Unite]];
        std::iter::once(vec![Step::Unite]).chain(vec![parting; PARTINGS].into_iter().flatten()).collect()
    }

    /// What may follow where that did not help: what still touches is bored.
    pub(super) fn boring_a_little() -> Vec<Vec<Step>> {
        LITTLE_BORINGS.map(|steps| vec![Step::BoreContacts { steps }]).into()
    }

    /// What may follow where nothing else helped.
    pub(super) fn boring_more() -> Vec<Vec<Step>> {
        MORE_BORINGS.map(|steps| vec![Step::BoreContacts { steps }]).into()
    }

    /// The steps that join what touches itself, or part it.
    fn parting(contact: Contact, choices: &Choices) -> Vec<Step> {
        let pinch = Step::Pinch(ChosenEdges::default(), StitchValidity::Exact);
        let mut steps = vec![pairing(contact), Step::Cut(CutOptions::default()), pinch];
        if contact == Contact::Join {
            steps.push(Step::JoinContacts { size: choices.wall });
        }
        steps.extend([Step::OpenContacts, Step::JoinCopies]);
        steps
    }

    /// The steps that take what is no triangle away and make vertices at one place one.
    pub(super) fn welding(self, choices: &Choices) -> Vec<Step> {
        let mut steps = vec![Step::SplitPolygons(DegenerateFaces::Split)];
        steps.extend(match self.noise {
            Noise::Stays => None,
            Noise::Joined => Some(Step::JoinOverNoise),
            Noise::Cleared => Some(Step::ClearNoise),
        });
        steps.extend(self.rounds.then_some(Step::RoundToF32));
        if self.coarse > 0 {
            steps.push(Step::RoundToCoarser { steps: self.coarse });
        }
        steps.extend([Step::Weld, Step::DropDegenerate]);
        steps.extend(choices.splits_collinear.then_some(Step::SplitCollinear));
        if !choices.removed_parts.is_empty() {
            steps.push(Step::RemoveParts(choices.removed_parts.clone()));
        }
        steps
    }

    /// Of the steps that mend the surface, those up to the joining of rims.
    pub(super) fn joining(self, choices: &Choices) -> Vec<Step> {
        let closes =
            |step: &Step| matches!(step, Step::MendThinFaces(_) | Step::Thicken { .. } | Step::FillHoles(_));
        self.mending(choices).into_iter().take_while(|step| !closes(step)).collect()
    }

    /// The steps that mend the surface, least invasive first; each finds what those before it leave.
    pub(super) fn mending(self, choices: &Choices) -> Vec<Step> {
        let single = [Step::SplitTVertices, Step::DropDuplicates(self.opposite)];
        let chosen = choices.snap_epsilon.filter(|&epsilon| epsilon > 0.0);
        let near = chosen.map(|epsilon| Step::DropNearDuplicates { epsilon });
        let remove = self.removes_crossing.map(|rings| Step::RemoveCrossing { rings });
        let orient = choices.orients.then_some(Step::Orient);
        // What is not cut cannot be joined by the rules of a manifold.
        let join = choices.cuts.then(|| {
            // Which copies belong together matters only where they come apart for good.
            let pair = self.contact.map(pairing);
            let pinch = self.contact.map(|_| Step::Pinch(ChosenEdges::default(), StitchValidity::Exact));
            let snap = Step::Snap(SnapOptions {
                epsilon: Some(choices.snap_epsilon.unwrap_or(self.snap_epsilon)),
                by_edge: choices.snap_epsilon.is_none(),
                keeps_winding: !choices.orients,
                ..SnapOptions::default()
            });
            pair.into_iter().chain([Step::Cut(CutOptions::default())]).chain(pinch).chain([snap])
        });
        let chordal = self.closes_chordal_gaps.then_some(Step::CloseChordalGaps);
        let turn = (self.bridges && choices.orients).then_some(Step::TurnToBridge);
        let fill = match self.thickens {
            true => Some(Step::Thicken { wall: choices.wall }),
            false => choices.fills_holes.then(|| Step::FillHoles(choices.filling(self.bridges))),
        };
        let thin = (self.mends_thin_faces && choices.mends_thin_faces())
            .then_some(Step::MendThinFaces(choices.thin_faces));
        let start = self.welding(choices).into_iter().chain(single).chain(near);
        let joined = start.chain(remove).chain(orient).chain(join.into_iter().flatten());
        let rest = self.thickens_rest.then_some(Step::Thicken { wall: choices.wall });
        joined.chain(chordal).chain(thin).chain(turn).chain(fill).chain(rest).collect()
    }

    /// The steps that make it a solid. Readers weld, so that copies of a vertex would be one again: what is to be
    /// certified has none. `has_contacts`: triangles of the input meet beyond common vertices and edges. Nothing that
    /// mends adds a contact, but moving vertices can.
    pub(super) fn solidifying(self, choices: &Choices, has_contacts: bool) -> Vec<Step> {
        let moves = self.thickens
            || self.thickens_rest
            || self.rounds
            || self.noise != Noise::Stays
            || self.contact.is_some()
            || choices.snap_epsilon.unwrap_or(self.snap_epsilon) > 0.0;
        let join = (self.contact == Some(Contact::Join)).then_some(Step::JoinContacts { size: choices.wall });
        let open = self.contact.map(|_| Step::OpenContacts);
        let nest = Step::Nest(NestOptions {
            policy: choices.nesting,
            is_embedded: !has_contacts && !moves,
            chosen: choices.shells.clone(),
        });
        join.into_iter().chain(open).chain([Step::JoinCopies, nest]).collect()
    }
}

/// What decides which copies belong together where bodies touch.
fn pairing(contact: Contact) -> Step {
    Step::PairSheets(match contact {
        Contact::Open => Across::Solid,
        Contact::Join => Across::Void,
    })
}

/// A mesh on its way through the steps of a plan.
#[derive(Debug, Clone)]
pub(super) struct Attempt {
    pub(super) draft: Draft,
    /// What the steps did, in their order.
    pub(super) actions: Vec<Action>,
    /// The steps that ran.
    pub(super) steps: Vec<Step>,
    /// What the filling told of each hole.
    pub(super) holes: Vec<HoleReport>,
    /// What the steps did that later attempts depend on.
    pub(super) effects: Effects,
    /// True when the edges that steps join are told one by one.
    lists_stitches: bool,
    /// True when no shell is turned before bodies are united: the draft was united as it points before.
    is_oriented: bool,
    /// Which triangles of the soup are known to be on the surface or inside of the solid.
    coverage: KnownCoverage,
    /// True when walls or patches may hide what can be seen in the file.
    pub(super) hides_more: bool,
    /// True when patches close openings, behind which something may be seen in the file.
    pub(super) closes_openings: bool,
}

/// Which triangles of the soup are known to be on the surface or inside of the solid, as bodies are united.
#[derive(Debug, Clone, PartialEq)]
enum KnownCoverage {
    /// Nothing was united yet.
    NotYet,
    /// All of `present` but `bare`.
    By(Coverage),
    /// It is not known any more.
    No,
}

/// What of the soup need not be looked for in a united mesh.
pub(super) struct Covered {
    /// Triangles of the soup, ascending, every place of which is on the surface or inside of the solid.
    pub(super) triangles: Vec<u32>,
    /// Area of them inside of the solid, in square units of the file.
    pub(super) buried_area: f64,
    /// How far from the surface the others may be by what steps moved, in the unit of the file.
    pub(super) moved: f64,
}

impl Attempt {
    /// The usable triangles of `soup`.
    pub(super) fn start(soup: &Soup, before: Option<&Analysis>) -> Self {
        let (draft, changes) = Draft::from_soup(soup);
        let actions = vec![action("take-usable", &UNUSABLE, changes, soup, before)];
        Self {
            draft,
            actions,
            steps: Vec::new(),
            holes: Vec::new(),
            effects: Effects::default(),
            lists_stitches: false,
            is_oriented: false,
            coverage: KnownCoverage::NotYet,
            hides_more: false,
            closes_openings: false,
        }
    }

    /// The usable faces of `soup`, polygons as such; the edges that steps join are told one by one.
    pub(super) fn start_with_polygons(soup: &Soup, before: Option<&Analysis>) -> Self {
        let (draft, changes) = Draft::with_polygons(soup);
        let actions = vec![action("take-usable", &UNUSABLE, changes, soup, before)];
        Self { draft, actions, lists_stitches: true, ..Self::start(&Soup::default(), None) }
    }

    /// The triangles of `soup`, of which each says what is solid behind it.
    pub(super) fn start_as_oriented(soup: &Soup) -> Self {
        let (draft, _) = Draft::from_soup(soup);
        Self { draft, actions: Vec::new(), is_oriented: true, ..Self::start(&Soup::default(), None) }
    }

    /// Runs `steps`, and notes what each did, and why by the defects found `before`.
    pub(super) fn run(
        &mut self,
        steps: &[Step],
        soup: &Soup,
        before: Option<&Analysis>,
        budget: &Budget,
    ) -> Result<(), Stopped> {
        for step in steps {
            budget.check()?;
            let mut changes = match step {
                Step::Unite if self.is_oriented => repair::unite::unite_as_oriented(&mut self.draft, budget)?,
                _ => step.run(&mut self.draft, soup, &mut self.holes, budget)?,
            };
            self.coverage.go_on(step, &mut changes);
            let adds = changes.count("triangles_added") > 0;
            self.hides_more |= adds && matches!(step, Step::Thicken { .. } | Step::SpanOddEdges);
            self.closes_openings |= adds && matches!(step, Step::FillHoles(_) | Step::SpanRims);
            self.effects.add(changes.effects);
            debug_assert_eq!(self.draft.check(), Vec::<String>::new(), "after {step:?}");
            let stitches = (self.lists_stitches && matches!(step, Step::Pinch(..) | Step::Snap(_)))
                .then(|| Stitches::of(&changes.stitches, soup));
            let action = action(step.name(), step.cures(), changes, soup, before);
            self.actions.push(Action { stitches, ..action });
            self.steps.push(step.clone());
        }
        Ok(())
    }

    /// True when bodies were united.
    pub(super) fn has_united(&self) -> bool {
        self.coverage != KnownCoverage::NotYet
    }

    /// What of the soup need not be looked for in the result, if bodies were united; nothing that is buried where that may be
    /// seen all the same.
    pub(super) fn covered(&self, looks_out: bool) -> Option<Covered> {
        let KnownCoverage::By(coverage) = &self.coverage else { return None };
        Some(self.covered_but(&coverage.bare, coverage, looks_out))
    }

    /// As [`covered`](Self::covered), if cavities are open where they reach the surface of their body: nor that surface there.
    pub(super) fn covered_but_for_mouths(&self, looks_out: bool) -> Option<Covered> {
        let KnownCoverage::By(coverage) = &self.coverage else { return None };
        let covered = || self.covered_but(&coverage.bare_beside_mouths, coverage, looks_out);
        (coverage.mouths > 0).then(covered)
    }

    fn covered_but(&self, bare: &[u32], coverage: &Coverage, looks_out: bool) -> Covered {
        let Coverage { present, buried, buried_area, .. } = coverage;
        let is_in = |list: &[u32], t: &u32| list.binary_search(t).is_ok();
        let is_covered = |t: &u32| !(is_in(bare, t) || looks_out && is_in(buried, t));
        Covered {
            triangles: present.iter().copied().filter(is_covered).collect(),
            buried_area: if looks_out { 0.0 } else { *buried_area },
            moved: self.actions.iter().map(|action| action.move_max).sum(),
        }
    }
}

impl KnownCoverage {
    /// Takes in what `step` did.
    fn go_on(&mut self, step: &Step, changes: &mut Changes) {
        let known = std::mem::replace(self, Self::No);
        *self = match (known, changes.coverage.take(), step) {
            // These take surface away or move it farther than they say.
            (_, _, Step::BoreContacts { .. } | Step::MendThinFaces(_)) => Self::No,
            (Self::NotYet, Some(coverage), _) => Self::By(coverage),
            (Self::By(mut known), Some(coverage), _) => {
                let more = [
                    (&mut known.bare, coverage.bare),
                    (&mut known.buried, coverage.buried),
                    (&mut known.bare_beside_mouths, coverage.bare_beside_mouths),
                ];
                for (known, more) in more {
                    known.extend(more);
                    known.sort_unstable();
                    known.dedup();
                }
                Self::By(known)
            }
            (known, ..) => known,
        };
    }
}

/// What taking the triangles of the file as they are leaves behind.
const UNUSABLE: [DefectCode; 8] = [
    DefectCode::NonFiniteVertex,
    DefectCode::NonFiniteFace,
    DefectCode::IndexOutOfRange,
    DefectCode::TooFewCorners,
    DefectCode::NonPlanarPolygon,
    DefectCode::ConcavePolygon,
    DefectCode::IsolatedVertex,
    DefectCode::IsolatedEdge,
];

fn action(
    step: &'static str,
    cures: &[DefectCode],
    changes: Changes,
    soup: &Soup,
    before: Option<&Analysis>,
) -> Action {
    let findings = before.map_or(&[][..], |analysis| &analysis.findings);
    let has = |code: &DefectCode| findings.iter().any(|f| f.code == *code && f.count > 0);
    Action {
        step,
        causes: cures.iter().copied().filter(has).collect(),
        changes: changes.counts,
        move_max: changes.move_max,
        reason: changes.reason + &parts_with_faces(&changes.removed_parts, soup),
        stitches: None,
    }
}

/// Parts that are gone that a reason lists one by one.
const PARTS_LISTED_MAX: usize = 16;

/// The parts that are gone, each by a face of the file.
fn parts_with_faces(removed_parts: &[u32], soup: &Soup) -> String {
    if removed_parts.is_empty() {
        return String::new();
    }
    let faces: Vec<String> =
        removed_parts.iter().take(PARTS_LISTED_MAX).map(|&t| soup.face_of(t).to_string()).collect();
    let more = if removed_parts.len() > PARTS_LISTED_MAX { " and others" } else { "" };
    format!(" (those with faces {}{more})", faces.join(", "))
}
