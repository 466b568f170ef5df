//! The commands and what they take.

use super::files::FileOrStream;
use super::flags::{EngineSettingFlags, OptionFlags, SettingFlags};
use crate::config::Sources;
use crate::jobs::LostStore;
use crate::pipeline::Operation;
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Repairs 3D meshes for printing and proves it: every returned file carries an exact certificate.
#[derive(Debug, Parser)]
#[command(name = "meshmend", version, disable_help_subcommand = true)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Run the service (the default command).
    Serve(ServeArguments),
    /// Report what is wrong with a mesh.
    #[command(arg_required_else_help = true)]
    Analyze(AnalyzeArguments),
    /// Report what is wrong with a mesh and what repair would do about it.
    #[command(arg_required_else_help = true)]
    Plan(AnalyzeArguments),
    /// Repair a mesh and certify the result; nothing is written unless it is certified.
    #[command(arg_required_else_help = true)]
    Repair(RepairArguments),
    /// Prove that a file is a valid solid, or show where it is not.
    #[command(arg_required_else_help = true)]
    Verify(VerifyArguments),
    /// Write a mesh in another format.
    #[command(arg_required_else_help = true)]
    Convert(ConvertArguments),
    /// Write a mesh with fewer triangles; its certificate says what holds. With several --targets each has a file of its own: OUT-1,
    /// OUT-2 and so on.
    #[command(arg_required_else_help = true)]
    Simplify(SimplifyArguments),
    /// Cut singular edges and vertices and join boundary edges; the certificate of the result says what holds.
    #[command(arg_required_else_help = true)]
    CutStitch(CutStitchArguments),
    /// Close holes; no vertex moves and every triangle stays. The certificate of the result says what holds.
    #[command(arg_required_else_help = true)]
    FillHoles(FillHolesArguments),
    /// Edit a closed polyhedron by its planes: move faces, split and merge vertices, flip edges; or tell how far faces
    /// may move. The certificate of the result says what holds.
    #[command(arg_required_else_help = true)]
    Modeller(ModellerArguments),
    /// Combine solids into one that is certified: their union, their intersection, or the first without all others.
    #[command(arg_required_else_help = true)]
    Boolean(BooleanArguments),
    /// Draw a mesh as a PNG file: defects coloured and marked, backs red; with --after a second mesh beside it.
    #[command(arg_required_else_help = true)]
    Render(RenderArguments),
    /// Say whether the faces of a file, as indexed, make a half-edge mesh (a manifold, coherently oriented).
    #[command(arg_required_else_help = true)]
    Check {
        /// Mesh file, or - for standard input.
        #[arg(value_name = "IN")]
        input: FileOrStream,
        /// Format of the input. Default: found from the content.
        #[arg(long, value_name = "WORD", value_parser = clap::builder::PossibleValuesParser::new(crate::wire::Format::WORDS))]
        format: Option<String>,
    },
    /// Print the completions of a shell: `meshmend completions bash > /etc/bash_completion.d/meshmend`.
    Completions {
        /// The shell.
        #[arg(value_name = "SHELL")]
        shell: clap_complete::Shell,
    },
    /// Write the manual pages, one for each command, into a folder.
    Man {
        /// The folder, which is made where it is missing.
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
    /// Exit with 0 if the service on this machine is ready (for containers).
    Healthcheck(ServiceArguments),
    /// Carry what is in data_dir over to the database and the bucket that the settings name; both must be empty, and no server
    /// may run on either side. Cut off, it can be run again.
    Migrate(ServiceArguments),
    /// Show or check the configuration.
    #[command(subcommand)]
    Config(SettingsCommand),
}

#[derive(Debug, Subcommand)]
pub(super) enum SettingsCommand {
    /// Print every setting with its value and where that is from.
    Show(ServiceArguments),
    /// Exit with 2 if the service could not start with this configuration.
    Check {
        #[command(flatten)]
        given: ServiceArguments,
        /// Take warnings, such as an unknown MESHMEND_ variable, as errors.
        #[arg(long)]
        strict: bool,
    },
}

#[derive(Debug, Args)]
pub(super) struct ServiceArguments {
    /// Configuration file (TOML) [MESHMEND_CONFIG].
    #[arg(long, value_name = "FILE", help_heading = "Settings", hide_short_help = true)]
    config: Option<PathBuf>,
    #[command(flatten)]
    settings: SettingFlags,
}

impl ServiceArguments {
    pub(super) fn sources(self) -> Sources {
        Sources::of_process(self.settings.0, self.config)
    }
}

#[derive(Debug, Args)]
pub(super) struct ServeArguments {
    /// Start although the job store is missing, empty or another one, and keep the files of the lost one in a folder of their
    /// own.
    #[arg(long, conflicts_with = "discard")]
    adopt: bool,
    /// Start although the job store is missing, empty or another one, and remove the files of the lost one.
    #[arg(long)]
    discard: bool,
    #[command(flatten)]
    given: ServiceArguments,
}

impl ServeArguments {
    pub(super) fn lost_store(&self) -> LostStore {
        match (self.adopt, self.discard) {
            (true, _) => LostStore::Adopt,
            (_, true) => LostStore::Discard,
            _ => LostStore::Refuse,
        }
    }

    pub(super) fn sources(self) -> Sources {
        self.given.sources()
    }
}

/// What every operation on a file takes.
#[derive(Debug, Args)]
struct InputArguments {
    /// Mesh file, or - for standard input, which needs --format. Several files are taken one after the other.
    #[arg(value_name = "IN", required = true, num_args = 1..)]
    inputs: Vec<FileOrStream>,
    /// Print the report as JSON on standard output; of several files one object a line, with the file's name as `input`.
    #[arg(long)]
    json: bool,
    /// Write the report for people to this file: one page that loads nothing.
    #[arg(long, value_name = "FILE")]
    report_html: Option<PathBuf>,
    /// Material file (MTL) of an OBJ: its diffuse colours become face colours, which OFF, PLY, 3MF and glTF hold.
    #[arg(long, value_name = "FILE")]
    material: Option<PathBuf>,
    #[command(flatten)]
    options: OptionFlags,
    /// Configuration file (TOML) [MESHMEND_CONFIG].
    #[arg(long, value_name = "FILE", help_heading = "Settings", hide_short_help = true)]
    config: Option<PathBuf>,
    #[command(flatten)]
    settings: EngineSettingFlags,
}

/// Where a result goes.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct OutputArguments {
    /// File to write, or - for standard output, which needs --output-format. Its extension names the format unless
    /// --output-format does.
    #[arg(short, long, value_name = "OUT")]
    output: Option<FileOrStream>,
    /// Folder to write results into, each under the name of its file; it is made where it is missing. With
    /// --output-format the extension follows the format.
    #[arg(short = 'd', long, value_name = "DIR")]
    out_dir: Option<PathBuf>,
}

impl OutputArguments {
    fn target(self) -> OutputTarget {
        match (self.output, self.out_dir) {
            (Some(place), _) => OutputTarget::Place(place),
            (None, Some(folder)) => OutputTarget::Folder(folder),
            (None, None) => OutputTarget::None,
        }
    }
}

/// Where results go.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum OutputTarget {
    /// Nothing is written.
    None,
    /// The result of the only file.
    Place(FileOrStream),
    /// The result of each file, under its name.
    Folder(PathBuf),
}

#[derive(Debug, Args)]
pub(super) struct AnalyzeArguments {
    #[command(flatten)]
    given: InputArguments,
}

#[derive(Debug, Args)]
pub(super) struct VerifyArguments {
    #[command(flatten)]
    given: InputArguments,
}

#[derive(Debug, Args)]
pub(super) struct RepairArguments {
    #[command(flatten)]
    given: InputArguments,
    #[command(flatten)]
    output: OutputArguments,
    /// Write the best result there is although it is not certified (--require best_effort); the exit code stays 1.
    #[arg(long)]
    best_effort: bool,
}

#[derive(Debug, Args)]
pub(super) struct ConvertArguments {
    #[command(flatten)]
    given: InputArguments,
    #[command(flatten)]
    output: OutputArguments,
}

#[derive(Debug, Args)]
pub(super) struct SimplifyArguments {
    #[command(flatten)]
    given: InputArguments,
    #[command(flatten)]
    output: OutputArguments,
}

#[derive(Debug, Args)]
pub(super) struct CutStitchArguments {
    #[command(flatten)]
    given: InputArguments,
    #[command(flatten)]
    output: OutputArguments,
}

#[derive(Debug, Args)]
pub(super) struct FillHolesArguments {
    #[command(flatten)]
    given: InputArguments,
    #[command(flatten)]
    output: OutputArguments,
}

#[derive(Debug, Args)]
pub(super) struct ModellerArguments {
    #[command(flatten)]
    given: InputArguments,
    /// File to write, or - for standard output, which needs --output-format. Its extension names the format unless
    /// --output-format does. Default: none is written, which is enough for --ranges and --list-faces.
    #[arg(short, long, value_name = "OUT")]
    output: Option<FileOrStream>,
}

#[derive(Debug, Args)]
pub(super) struct BooleanArguments {
    #[command(flatten)]
    given: InputArguments,
    /// File to write, or - for standard output, which needs --output-format. Its extension names the format unless
    /// --output-format does.
    #[arg(short, long, value_name = "OUT")]
    output: FileOrStream,
}

#[derive(Debug, Args)]
#[group(id = "picture", required = true, multiple = false, args = ["output", "out_dir"])]
pub(super) struct RenderArguments {
    #[command(flatten)]
    given: InputArguments,
    /// Picture to write, or - for standard output: a PNG, or with the extension .glb a mesh to turn.
    #[arg(short, long, value_name = "OUT")]
    output: Option<FileOrStream>,
    /// Folder to write pictures into, each under the name of its file; it is made where it is missing.
    #[arg(short = 'd', long, value_name = "DIR")]
    out_dir: Option<PathBuf>,
    /// A second mesh, drawn beside the first at the same scale; triangles that the first has not are green.
    #[arg(long, value_name = "FILE")]
    after: Option<PathBuf>,
}

/// An operation on a file, whichever command named it.
#[derive(Debug, Clone)]
pub(super) struct Request {
    pub operation: Operation,
    /// One or more.
    pub inputs: Vec<FileOrStream>,
    pub target: OutputTarget,
    pub is_json: bool,
    pub report_html: Option<PathBuf>,
    pub material: Option<PathBuf>,
    /// The second mesh of a picture.
    pub after: Option<PathBuf>,
    /// Names and values of options.
    pub options: Vec<(String, String)>,
    pub sources: Sources,
}

impl InputArguments {
    fn request(self, operation: Operation, target: OutputTarget) -> Request {
        Request {
            operation,
            inputs: self.inputs,
            target,
            is_json: self.json,
            report_html: self.report_html,
            material: self.material,
            after: None,
            options: self.options.0,
            sources: Sources::of_process(self.settings.0, self.config),
        }
    }
}

impl AnalyzeArguments {
    pub(super) fn request(self, operation: Operation) -> Request {
        self.given.request(operation, OutputTarget::None)
    }
}

impl From<VerifyArguments> for Request {
    fn from(given: VerifyArguments) -> Self {
        given.given.request(Operation::Verify, OutputTarget::None)
    }
}

impl From<RepairArguments> for Request {
    fn from(given: RepairArguments) -> Self {
        let mut request = given.given.request(Operation::Repair, given.output.target());
        if given.best_effort {
            request.options.push(("require".to_owned(), "best_effort".to_owned()));
        }
        request
    }
}

impl From<SimplifyArguments> for Request {
    fn from(given: SimplifyArguments) -> Self {
        given.given.request(Operation::Simplify, given.output.target())
    }
}

impl From<CutStitchArguments> for Request {
    fn from(given: CutStitchArguments) -> Self {
        given.given.request(Operation::CutStitch, given.output.target())
    }
}

impl From<FillHolesArguments> for Request {
    fn from(given: FillHolesArguments) -> Self {
        given.given.request(Operation::FillHoles, given.output.target())
    }
}

impl From<ModellerArguments> for Request {
    fn from(given: ModellerArguments) -> Self {
        given.given.request(Operation::Modeller, given.output.map_or(OutputTarget::None, OutputTarget::Place))
    }
}

impl From<BooleanArguments> for Request {
    fn from(given: BooleanArguments) -> Self {
        given.given.request(Operation::Boolean, OutputTarget::Place(given.output))
    }
}

impl From<RenderArguments> for Request {
    fn from(given: RenderArguments) -> Self {
        let target = OutputArguments { output: given.output, out_dir: given.out_dir }.target();
        Self { after: given.after, ..given.given.request(Operation::Render, target) }
    }
}

impl From<ConvertArguments> for Request {
    fn from(given: ConvertArguments) -> Self {
        given.given.request(Operation::Convert, given.output.target())
    }
}
