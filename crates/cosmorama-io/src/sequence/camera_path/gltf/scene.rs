use std::collections::HashMap;

use gltf::animation::{Channel, Property};
use gltf::{Animation, Document, Node};

use super::wrong;
use crate::sequence::camera_path::{CameraPathError, PathSource};

/// Nodes of a file, with what they hang on.
pub(super) struct Scene<'a> {
    nodes: Vec<Node<'a>>,
    parents: Vec<Option<usize>>,
    animations: Vec<Animation<'a>>,
}

/// Number of names that a message lists.
const LISTED: usize = 12;

impl<'a> Scene<'a> {
    pub(super) fn new(document: &'a Document) -> Self {
        let nodes: Vec<Node> = document.nodes().collect();
        let mut parents = vec![None; nodes.len()];
        for node in &nodes {
            node.children().for_each(|child| parents[child.index()] = Some(node.index()));
        }
        Self { nodes, parents, animations: document.animations().collect() }
    }

    pub(super) fn node(&self, index: usize) -> Node<'a> {
        self.nodes[index].clone()
    }

    /// Returns a node with all that it hangs on, the outermost first.
    pub(super) fn chain(&self, node: usize) -> Vec<usize> {
        let (mut chain, mut seen) = (Vec::new(), vec![false; self.nodes.len()]);
        let mut next = Some(node);
        // A damaged file may have a circle of parents.
        while let Some(node) = next.filter(|node| !seen[*node]) {
            seen[node] = true;
            chain.push(node);
            next = self.parents[node];
        }
        chain.reverse();
        chain
    }

    /// Returns the first channel that turns each node that is turned. Some programs write an animation for each node.
    pub(super) fn rotations(&self) -> HashMap<usize, Channel<'a>> {
        let mut first = HashMap::new();
        for channel in self.channels(Property::Rotation) {
            let node = channel.target().node().index();
            first.entry(node).or_insert(channel);
        }
        first
    }

    /// Visits the channels of all animations that change a property.
    fn channels(&self, property: Property) -> impl Iterator<Item = Channel<'a>> {
        let channels = self.animations.iter().flat_map(Animation::channels);
        channels.filter(move |channel| channel.target().property() == property)
    }

    /// Returns whether an animation turns a node, or what it hangs on.
    pub(super) fn is_turned(&self, node: usize) -> bool {
        self.is_animated(node, Property::Rotation)
    }

    /// Returns whether an animation changes a property of a node, or of what it hangs on.
    pub(super) fn is_animated(&self, node: usize, property: Property) -> bool {
        let mut holds = vec![false; self.nodes.len()];
        self.chain(node).into_iter().for_each(|node| holds[node] = true);
        self.channels(property).any(|channel| holds[channel.target().node().index()])
    }

    /// Returns of each node whether an animation turns it, or what it hangs on.
    fn turned(&self) -> Vec<bool> {
        let (mut turned, mut known) = (vec![false; self.nodes.len()], vec![false; self.nodes.len()]);
        self.channels(Property::Rotation).for_each(|channel| turned[channel.target().node().index()] = true);
        for node in 0..self.nodes.len() {
            let (mut unknown, mut next) = (Vec::new(), Some(node));
            while let Some(node) = next.filter(|node| !known[*node]) {
                known[node] = true;
                unknown.push(node);
                next = self.parents[node];
            }
            let mut is_turned = next.is_some_and(|node| turned[node]);
            for node in unknown.into_iter().rev() {
                is_turned |= turned[node];
                turned[node] = is_turned;
            }
        }
        turned
    }

    /// Returns the node's own name, its camera's, or its number.
    pub(super) fn name_of(&self, node: usize) -> String {
        let found = &self.nodes[node];
        let camera = || found.camera().and_then(|camera| camera.name().map(ToOwned::to_owned));
        found.name().map(ToOwned::to_owned).or_else(camera).unwrap_or_else(|| format!("node {node}"))
    }

    /// Chooses the node that is named, or else the only camera, or the only one that an animation turns.
    pub(super) fn choose(&self, source: &PathSource) -> Result<usize, CameraPathError> {
        let cameras: Vec<usize> = (0..self.nodes.len()).filter(|index| self.nodes[*index].camera().is_some()).collect();
        if let Some(wanted) = source.node {
            let is_camera =
                |index: &usize| self.nodes[*index].camera().and_then(|camera| camera.name()) == Some(wanted);
            let mut named = (0..self.nodes.len()).filter(|index| self.nodes[*index].name() == Some(wanted));
            return named.next().or_else(|| cameras.iter().copied().find(is_camera)).ok_or_else(|| {
                let all: Vec<usize> = (0..self.nodes.len()).collect();
                wrong(source.name, format!("no camera or node {wanted}; there are {}", self.listed(&all)))
            });
        }
        let turned = self.turned();
        let turning: Vec<usize> = cameras.iter().copied().filter(|camera| turned[*camera]).collect();
        match (&cameras[..], &turning[..]) {
            (&[only], _) | (_, &[only]) => Ok(only),
            ([], _) => {
                let all: Vec<usize> = (0..self.nodes.len()).collect();
                let found = if all.is_empty() { String::new() } else { format!("; there are {}", self.listed(&all)) };
                let file = source.name.display();
                Err(wrong(
                    source.name,
                    format!("no camera in it; name the node that is to turn, as in {file}#NAME{found}"),
                ))
            }
            _ => {
                let file = source.name.display();
                let found = self.listed(&cameras);
                Err(wrong(
                    source.name,
                    format!("several cameras: {found}; name one, as in {file}#{}", self.name_of(cameras[0])),
                ))
            }
        }
    }

    fn listed(&self, nodes: &[usize]) -> String {
        let mut names: Vec<String> = nodes.iter().take(LISTED).map(|node| self.name_of(*node)).collect();
        if nodes.len() > LISTED {
            return format!("{} and {} more", names.join(", "), nodes.len() - LISTED);
        }
        match (names.pop(), names.is_empty()) {
            (Some(last), false) => format!("{} and {last}", names.join(", ")),
            (last, _) => last.unwrap_or_default(),
        }
    }
}
