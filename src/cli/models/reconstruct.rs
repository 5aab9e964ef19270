//! `fragscale reconstruct`: photos become a flight, here or on a node.

use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};

use crate::cli::{Answer, interrupt};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::node_odm::{Address, Asked, Limits, NodeRequest, Token, reconstruct_on_node};
use crate::reconstruct::{
    Card, EngineName, Quality, Reconstructed, Request, left_out, reconstruct, summary,
};

#[derive(Debug, Args)]
pub(in crate::cli) struct ReconstructArguments {
    /// The folder of the photos.
    photos: PathBuf,
    /// The folder to make, with a flight.toml; new or empty, or one of a run that was interrupted, which
    /// goes on. In a finished one the same photos' cloud is made anew, from the same poses.
    #[arg(long, value_name = "DIR")]
    to: PathBuf,
    /// The coordinate system of the world: EPSG:n, WKT or a PROJ text; without it the zone of UTM that
    /// the photos lie in.
    #[arg(long, value_name = "CRS", allow_hyphen_values = true)]
    crs: Option<String>,
    /// The calibration of the photos' camera, which is kept; without it the lens is found from the photos.
    #[arg(long, value_name = "FILE")]
    camera: Option<PathBuf>,
    /// What finds the poses.
    #[arg(long, value_enum, default_value_t)]
    engine: PosesEngine,
    /// How much time the cloud may take.
    #[arg(long, value_enum, default_value_t)]
    quality: CloudQuality,
    /// Let the processor do all, also where there is a graphics card.
    #[arg(long)]
    no_gpu: bool,
    #[command(flatten)]
    node: NodeArguments,
}

/// Where another computer is to reconstruct.
#[derive(Debug, Args)]
#[command(next_help_heading = "On another computer")]
struct NodeArguments {
    /// Let this NodeODM or ClusterODM reconstruct: http://HOST:PORT or https://HOST. Photos, where they were
    /// taken and the photos' gcp_list.txt are sent there and nowhere else; the results are fetched, and
    /// removed there.
    // (Read later: clap would repeat a token that somebody puts into it.)
    #[arg(
        long,
        value_name = "URL",
        conflicts_with_all = ["crs", "camera", "engine", "quality", "no_gpu"]
    )]
    node: Option<String>,
    /// What opens the node. Other users of this computer can read it in the list of processes: better set the
    /// environment variable FRAGSCALE_NODE_TOKEN.
    #[arg(long, value_name = "TOKEN", requires = "node")]
    token: Option<String>,
    /// An option of OpenDroneMap, like pc-quality=high; a name alone is name=true. May be repeated.
    #[arg(long, value_name = "NAME=VALUE", value_parser = Asked::parse, requires = "node")]
    option: Vec<Asked>,
    /// Ground control points with their marks in photos, as OpenDroneMap's gcp_list.txt; without it the one
    /// among the photos, if there is one.
    #[arg(long, value_name = "FILE", requires = "node")]
    gcp: Option<PathBuf>,
    /// Let photos and token cross the network unencrypted, where the node has http:// and is another computer.
    #[arg(long, requires = "node")]
    insecure: bool,
    /// How many minutes a node that does not answer is asked again.
    #[arg(long, value_name = "MINUTES", default_value = "10", requires = "node", value_parser = minutes)]
    give_up_after: f64,
}

fn minutes(typed: &str) -> Result<f64, Fault> {
    let minutes = typed
        .parse()
        .ok()
        .filter(|minutes: &f64| minutes.is_finite() && *minutes > 0.0);
    minutes.ok_or_else(|| Fault::new("it is no number of minutes", "write it as 10 or 0.5"))
}

impl ReconstructArguments {
    /// What stays of it where it is interrupted.
    pub(in crate::cli) fn kept(&self) -> String {
        let to = self.to.display();
        match &self.node.node {
            None => format!("what is done lies in {to}: the same command goes on with it"),
            // Where calling it off takes too long.
            Some(_) => {
                "the node may go on with the task: the same command goes on with it".to_owned()
            }
        }
    }

    /// How long it has to end what it has started, where it is interrupted.
    pub(in crate::cli) fn takes_long_to_end(&self) -> bool {
        self.node.node.is_some()
    }
}

/// A quality as a word of the command line.
#[derive(Debug, Clone, Copy, Default)]
struct CloudQuality(Quality);

impl ValueEnum for CloudQuality {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [CloudQuality; 3] = [
            CloudQuality(Quality::Fast),
            CloudQuality(Quality::Normal),
            CloudQuality(Quality::Best),
        ];
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0.as_str()).help(self.0.explained()))
    }
}

/// An engine as a word of the command line.
#[derive(Debug, Clone, Copy, Default)]
struct PosesEngine(EngineName);

impl ValueEnum for PosesEngine {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [PosesEngine; 2] = [
            PosesEngine(EngineName::Embedded),
            PosesEngine(EngineName::Colmap),
        ];
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0.as_str()).help(self.0.explained()))
    }
}

pub(in crate::cli) fn run(
    arguments: &ReconstructArguments,
    progress: &Progress,
) -> Result<Answer, String> {
    let made = match &arguments.node.node {
        Some(node) => on_node(arguments, node, progress)?,
        None => here(arguments, progress)?,
    };
    let mut warnings = left_out(&made.left_out, made.photos);
    warnings.extend(made.warnings.iter().cloned());
    let lines = summary(&made).into_iter().map(|line| line + "\n");
    Ok(Answer::new(lines.collect::<String>(), warnings))
}

fn here(arguments: &ReconstructArguments, progress: &Progress) -> Result<Reconstructed, String> {
    let request = Request {
        photos: arguments.photos.clone(),
        to: arguments.to.clone(),
        crs: arguments.crs.clone(),
        camera: arguments.camera.clone(),
        dense: arguments.quality.0.dense(),
        card: (!arguments.no_gpu).then(Card::found).flatten(),
    };
    let engine = arguments.engine.0.engine();
    let engine = engine.map_err(|fault| fault.to_string())?;
    reconstruct(&request, &*engine, progress).map_err(|error| error.to_string())
}

fn on_node(
    arguments: &ReconstructArguments,
    node: &str,
    progress: &Progress,
) -> Result<Reconstructed, String> {
    let given = &arguments.node;
    let node = Address::parse(node).map_err(|fault| format!("--node: {fault}"))?;
    let request = NodeRequest {
        photos: arguments.photos.clone(),
        to: arguments.to.clone(),
        node,
        token: Token::typed_or_set(given.token.as_deref().unwrap_or_default()),
        insecure: given.insecure,
        options: given.option.clone(),
        control_points: given.gcp.clone(),
        limits: Limits::default().giving_up_after(given.give_up_after),
    };
    // (The node's messages stand beside the bar and in the log.)
    let made = reconstruct_on_node(&request, &|_| {}, progress);
    made.map_err(|error| {
        if progress.is_cancelled() {
            interrupt::keeps(&error.fault.to_string());
        }
        error.to_string()
    })
}
