//! Pictures of a run: the mesh as uploaded with its defects, the result with its new triangles, from one side or several,
//! or turning.

mod model;
mod paint;

use self::model::model;
use self::paint::{MeshRole, Painted};
use super::{Answer, Failure, Input, Operation, Options, Report, Units};
use crate::analysis::{Element, Finding, Witness};
use crate::budget::{Budget, Stage, Stopped};
use crate::formats::{self, ReadLimits, ReadOptions};
use crate::geom::DVec3;
use crate::mesh::Soup;
use crate::render::{
    Camera, Canvas, DrawnEdges, FramedScene, LETTER_HEIGHT, LETTER_WIDTH, Projection, Rgb, SIDE_MAX,
    SIDE_MIN, SceneFrame, Shade, Style, View, animation, draw, picture,
};

/// What kind of file a picture is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PictureFormat {
    /// Pixels, or several pictures that move.
    #[default]
    Png,
    /// A mesh that a viewer turns.
    Glb,
}

/// What a picture shows, and how.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PictureChoices {
    /// From which sides; one below the other where before and after stand side by side, in a grid otherwise.
    pub views: Vec<View>,
    /// Width of each view in pixels.
    pub width: u32,
    /// Height of each view in pixels.
    pub height: u32,
    /// How faces are shaded.
    pub shade: Shade,
    /// Which edges are drawn.
    pub edges: DrawnEdges,
    /// How depth changes what is seen.
    pub projection: Projection,
    /// Whether defects are coloured and marked.
    pub shows_defects: bool,
    /// Pictures of a full turn around z, as an animation; 0: none, the views instead.
    pub turn_pictures: u32,
    /// What it is; a mesh has colours and marks only.
    pub format: PictureFormat,
}

impl PictureChoices {
    /// Width and height of a view of `render`, where it is not told another one.
    pub const RENDERED: (u32, u32) = (640, 480);
}

impl Default for PictureChoices {
    /// What is kept of a job: a picture for a list or a mail.
    fn default() -> Self {
        Self {
            views: vec![View::Iso],
            width: 480,
            height: 360,
            shade: Shade::Smooth,
            edges: DrawnEdges::Creases,
            projection: Projection::Orthographic,
            shows_defects: true,
            turn_pictures: 0,
            format: PictureFormat::Png,
        }
    }
}

/// Colour behind everything.
const BACKGROUND: Rgb = [255, 255, 255];
/// Colour of backs, so that holes and inverted parts are seen.
const BACK: Rgb = [207, 63, 54];
/// Colour of words.
const INK: Rgb = [52, 62, 72];
/// Dots around words.
const MARGIN: usize = 5;
/// Dots from one line to the next.
const LINE_HEIGHT: usize = LETTER_HEIGHT + 3;
/// How far the eye of a turn is above the horizon, in degrees.
const TURN_ELEVATION: f64 = 24.0;
/// Time of a full turn in milliseconds.
const TURN_MS: u32 = 6000;

/// How `options` ask for a picture; `None`: they ask for none.
pub(super) fn choices(operation: Operation, options: &Options) -> Option<PictureChoices> {
    let (width, height) = PictureChoices::RENDERED;
    let usual = || PictureChoices { width, height, ..PictureChoices::default() };
    options.picture.clone().or_else(|| (operation == Operation::Render).then(usual))
}

/// What is drawn of a file.
pub(super) struct Drawn<'d> {
    /// All its triangles, in the unit of the result.
    pub(super) soup: &'d Soup,
    /// Its defects, with faces, half-edges and places of `soup`.
    pub(super) findings: &'d [Finding],
    /// Numbers of the first vertices of its meshes, each of which was judged by itself; empty: it is one.
    pub(super) meshes: &'d [u32],
}

/// By how much the numbers of a mesh are larger where it is drawn with others.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shift {
    pub(super) face: u32,
    /// `None`: triangles are not known by their numbers.
    pub(super) triangle: Option<u32>,
}

impl Shift {
    /// `finding` with at most `witnesses_max` of its witnesses, moved by `place`.
    pub(super) fn shifted(
        self,
        finding: &Finding,
        witnesses_max: usize,
        place: impl Fn(DVec3) -> DVec3,
    ) -> Finding {
        let face = |element: &Element| Element { index: element.index.saturating_add(self.face), ..*element };
        let witness = |witness: &Witness| Witness {
            faces: witness.faces.iter().map(face).collect(),
            position: witness.position.map(&place),
            anchor: witness.anchor.zip(self.triangle).map(|(anchor, by)| anchor.saturating_add(3 * by)),
            ..witness.clone()
        };
        let witnesses = finding.witnesses.iter().take(witnesses_max).map(witness).collect();
        Finding { witnesses, ..*finding }
    }
}

/// The picture of one mesh that was read; `None`: none is asked for.
pub(super) fn of_mesh(
    operation: Operation,
    input: &Input,
    answer: &Answer,
    options: &Options,
    budget: &Budget,
) -> Result<Option<Vec<u8>>, Failure> {
    let Some(choices) = choices(operation, options) else { return Ok(None) };
    let findings = answer.report.before.as_ref().map_or(&[][..], |analysis| &analysis.findings);
    make(&Drawn { soup: &input.soup, findings, meshes: &[] }, answer, &choices, options, budget).map(Some)
}

/// The picture of several meshes that became one; `starts` are their first vertices, triangles and faces in that of
/// `input`.
pub(super) fn of_meshes(
    input: &Input,
    starts: &[[u32; 3]],
    answer: &Answer,
    options: &Options,
    budget: &Budget,
) -> Result<Option<Vec<u8>>, Failure> {
    let Some(choices) = choices(answer.report.operation, options) else { return Ok(None) };
    let Report { before, further_inputs, .. } = &answer.report;
    let analyses = std::iter::once(before).chain(further_inputs.iter().map(|further| &further.before));
    let findings: Vec<Finding> = analyses
        .zip(starts)
        .flat_map(|(analysis, &[_, triangle, face])| {
            let shift = Shift { face, triangle: Some(triangle) };
            let findings = analysis.iter().flat_map(|analysis| &analysis.findings);
            findings.map(move |finding| shift.shifted(finding, usize::MAX, |p| p))
        })
        .collect();
    let meshes: Vec<u32> = starts.iter().map(|[vertex, ..]| *vertex).collect();
    let drawn = Drawn { soup: &input.soup, findings: &findings, meshes: &meshes };
    make(&drawn, answer, &choices, options, budget).map(Some)
}

/// The picture of `drawn`, and of the result beside it if there is one.
pub(super) fn make(
    drawn: &Drawn<'_>,
    answer: &Answer,
    choices: &PictureChoices,
    options: &Options,
    budget: &Budget,
) -> Result<Vec<u8>, Failure> {
    budget.stage(Stage::Draw, || {
        let after = read_after(answer, options, budget)?;
        let units = answer.report.input.result_units;
        let before = Painted::before(drawn, choices.shows_defects, after.is_some(), units, budget)?;
        let after_painted =
            after.as_ref().map(|soup| Painted::after(drawn.soup, soup, units, budget)).transpose()?;
        let sides: Vec<(&Soup, Painted)> =
            std::iter::once((drawn.soup, before)).chain(after.as_ref().zip(after_painted)).collect();
        match choices.format {
            PictureFormat::Png => Ok(sheet(&sides, choices, budget)?),
            PictureFormat::Glb => model(&sides, units, budget),
        }
    })
}

/// The mesh that stands beside the uploaded one, if there is one: a second file in the unit of the first, or the result.
fn read_after(answer: &Answer, options: &Options, budget: &Budget) -> Result<Option<Soup>, Failure> {
    if let Some(bytes) = &options.after {
        let in_after = |failure: Failure| Failure::InMesh { number: 2, failure: Box::new(failure) };
        let encoding = formats::sniff(bytes, None).map_err(|error| in_after(error.into()))?;
        let mut soup = formats::read(bytes, encoding, &options.read, budget).map_err(|error| {
            match Failure::from(error) {
                stopped @ Failure::Stopped(_) => stopped,
                failure => in_after(failure),
            }
        })?;
        let of_format = encoding.format().is_in_metres().then_some(Units::Metre);
        if let Some(units) = soup.units.or(of_format) {
            scale(&mut soup, units.millimetres() / answer.report.input.result_units.millimetres());
        }
        return Ok(Some(soup));
    }
    // A result that is the file itself would be the same picture again.
    let made = answer.output.as_ref().filter(|_| answer.report.after.is_some());
    let Some((bytes, output)) = made.and_then(|output| output.bytes.as_ref().zip(Some(output))) else {
        return Ok(None);
    };
    // What we write may be larger than what we would take in.
    let limits =
        ReadLimits { triangles_max: u32::MAX, vertices_max: u32::MAX, polygon_corners_max: u32::MAX };
    let options = ReadOptions { limits, ..ReadOptions::default() };
    Ok(Some(formats::read(bytes, output.encoding, &options, budget)?))
}

/// Changes the unit of `soup`; what would be out of range stays where it is at the end of the range.
fn scale(soup: &mut Soup, factor: f64) {
    if factor != 1.0 {
        let most = DVec3::splat(f64::MAX);
        for position in soup.positions.iter_mut().filter(|position| position.is_finite()) {
            *position = (*position * factor).clamp(-most, most);
        }
    }
}

/// All views of all sides, as PNG.
fn sheet(sides: &[(&Soup, Painted)], choices: &PictureChoices, budget: &Budget) -> Result<Vec<u8>, Stopped> {
    let [width, height] = [choices.width, choices.height].map(|side| side.clamp(SIDE_MIN, SIDE_MAX));
    let frame = SceneFrame::around(sides.iter().map(|(soup, painted)| painted.scene(soup).bounds()));
    let models = sides
        .iter()
        .map(|(soup, painted)| FramedScene::of(painted.scene(soup), frame, choices.shade, budget))
        .collect::<Result<Vec<_>, _>>()?;
    let all: Vec<&FramedScene<'_>> = models.iter().collect();
    let columns = if sides.len() > 1 { sides.len() } else { columns_of(choices.views.len()) };
    let views = if choices.turn_pictures > 0 { 1 } else { choices.views.len() };
    let footer = Footer::of(sides, [width, height], (views * sides.len()).div_ceil(columns));
    let height = height - footer.taken;
    let aspect = f64::from(width) / f64::from(height);
    let style = Style { edges: choices.edges, background: BACKGROUND, back: Some(BACK) };
    let tile = |camera: &Camera, side: usize, view: Option<View>| {
        let mut canvas = draw(all[side], camera, width, height, &style, budget)?;
        entitle(&mut canvas, &sides[side].1, view);
        Ok(canvas)
    };
    if choices.turn_pictures > 0 {
        let pictures = choices.turn_pictures;
        let camera = Camera::turning(&all, TURN_ELEVATION, aspect, budget)?;
        let pixels = u64::from(width) * u64::from(height) * sides.len() as u64;
        // A row of tiles and the same as one, and the file as it grows.
        let _memory = budget.charge(6 * pixels)?;
        let (mut of_file, mut charged) = (Vec::new(), 0);
        let frame = |number: u32, file_bytes: usize| {
            of_file.push(budget.charge((file_bytes - charged) as u64)?);
            charged = file_bytes;
            budget.spend(pixels / 4)?;
            // From the front and the right, as the iso view.
            let camera = camera(45.0 + 360.0 * f64::from(number) / f64::from(pictures));
            let row = (0..sides.len())
                .map(|side| tile(&camera, side, None))
                .collect::<Result<Vec<_>, Stopped>>()?;
            Ok(footer.below(&grid(&row, row.len())))
        };
        return animation(pictures, (TURN_MS / pictures) as u16, frame);
    }
    let mut tiles = Vec::new();
    let _memory = budget
        .charge(u64::from(width) * u64::from(height) * 6 * sides.len() as u64 * choices.views.len() as u64)?;
    for &view in &choices.views {
        let camera = Camera::at(&all, view.direction(), choices.projection, aspect, budget)?;
        let named = (choices.views.len() > 1).then_some(view);
        for side in 0..sides.len() {
            tiles.push(tile(&camera, side, named)?);
        }
    }
    Ok(picture(&footer.below(&grid(&tiles, columns))))
}

/// Columns of a grid of so many tiles that is about as wide as high.
fn columns_of(tiles: usize) -> usize {
    (1..).find(|columns| columns * columns >= tiles).unwrap_or(1)
}

/// Tiles of one size, row by row.
fn grid(tiles: &[Canvas], columns: usize) -> Canvas {
    let Some(first) = tiles.first() else { return Canvas::filled(1, 1, BACKGROUND) };
    let (width, height) = (first.width(), first.height());
    let rows = tiles.len().div_ceil(columns.max(1));
    let mut canvas = Canvas::filled(width * columns, height * rows, BACKGROUND);
    for (at, tile) in tiles.iter().enumerate() {
        canvas.put(tile, at % columns * width, at / columns * height);
    }
    canvas
}

/// Pixels for each dot of a letter, so that letters are about a thirtieth of the width of a tile.
fn scale_of(tile_width: usize) -> usize {
    ((tile_width + 120) / 300).max(1)
}

/// Names the side and the view at the top of a tile.
fn entitle(canvas: &mut Canvas, painted: &Painted, view: Option<View>) {
    let scale = scale_of(canvas.width());
    let side = match painted.side {
        MeshRole::Only => "",
        MeshRole::Before => "before",
        MeshRole::After => "after",
    };
    let title = [side, view.map_or("", View::name)].join(" ");
    canvas.write(title.trim(), MARGIN * scale, MARGIN * scale, scale, INK);
}

/// A line of text; a colour that it explains stands before it.
type LegendLine<'p> = (Option<Rgb>, &'p str);

/// What the colours mean and the size of each side, below all tiles.
struct Footer<'p> {
    /// Of each side.
    columns: Vec<Vec<LegendLine<'p>>>,
    column_width: usize,
    /// Pixels for each dot.
    scale: usize,
    /// Height in pixels.
    height: usize,
    /// By how much each tile is lower for it, so that the picture is not higher.
    taken: u32,
}

impl<'p> Footer<'p> {
    /// Below `rows` of tiles that would be of this size without it. It takes two fifths of the picture at most; further lines
    /// are left out.
    fn of(sides: &'p [(&Soup, Painted)], tile: [u32; 2], rows: usize) -> Self {
        let ([tile_width, tile_height], rows) = (tile.map(|side| side as usize), rows.max(1));
        let scale = scale_of(tile_width);
        let line_height = LINE_HEIGHT * scale;
        let room = (rows * tile_height * 2 / 5).saturating_sub(MARGIN * scale) / line_height;
        let columns: Vec<Vec<LegendLine<'p>>> =
            sides.iter().map(|(_, painted)| lines_of(painted, room)).collect();
        let lines = columns.iter().map(Vec::len).max().unwrap_or(0);
        let height = if lines > 0 { lines * line_height + MARGIN * scale } else { 0 };
        let taken = height.div_ceil(rows);
        Self { columns, column_width: tile_width, scale, height: taken * rows, taken: taken as u32 }
    }

    /// The picture of `tiles` with the text below.
    fn below(&self, tiles: &Canvas) -> Canvas {
        let mut canvas = Canvas::filled(tiles.width(), tiles.height() + self.height, BACKGROUND);
        canvas.put(tiles, 0, 0);
        for (side, lines) in self.columns.iter().enumerate() {
            // One side has the whole width for its text.
            let width = if self.columns.len() == 1 { tiles.width() } else { self.column_width };
            for (line, number) in lines.iter().zip(0..) {
                let y = tiles.height() + number * LINE_HEIGHT * self.scale;
                self.write(&mut canvas, line, [side * self.column_width, y], width);
            }
        }
        canvas
    }

    /// Writes `line` into a column that begins at `x` and is `width` wide.
    fn write(&self, canvas: &mut Canvas, (color, text): &LegendLine<'_>, [x, y]: [usize; 2], width: usize) {
        let Self { scale, .. } = *self;
        let (mut left, right) = (x + MARGIN * scale, x + width.saturating_sub(MARGIN * scale));
        if let Some(color) = color {
            canvas.fill(left, y, LETTER_HEIGHT * scale, LETTER_HEIGHT * scale, *color);
            left += (LETTER_HEIGHT + 3) * scale;
        }
        let fitting = right.saturating_sub(left) / ((LETTER_WIDTH + 1) * scale);
        canvas.write(&text.chars().take(fitting).collect::<String>(), left, y, scale, INK);
    }
}

/// What the colours of a side mean and its size, in `room` lines at most; the size is told before further colours.
fn lines_of(painted: &Painted, room: usize) -> Vec<LegendLine<'_>> {
    let size = (!painted.size.is_empty() && room > 0).then_some((None, painted.size.as_str()));
    let legend = painted.legend.iter().map(|(color, text)| (Some(*color), text.as_str()));
    legend.take(room - usize::from(size.is_some())).chain(size).collect()
}

#[cfg(test)]
mod tests;
