{{- define "meshmend.name" -}}
{{- if contains "meshmend" .Release.Name }}{{ .Release.Name | trunc 52 | trimSuffix "-" }}{{ else }}{{ printf "%s-meshmend" (.Release.Name | trunc 43) }}{{ end }}
{{- end }}

{{- define "meshmend.selector" -}}
app.kubernetes.io/name: meshmend
app.kubernetes.io/instance: {{ .Release.Name }}
{{- end }}

{{- /* What a server does, where there are several: of its role. Alone it has no such label, as its service has none. */ -}}
{{- define "meshmend.component" -}}
{{- if ne . "all" }}app.kubernetes.io/component: {{ . }}{{ end }}
{{- end }}

{{- define "meshmend.labels" -}}
{{ include "meshmend.selector" . }}
app.kubernetes.io/version: {{ .Chart.AppVersion | quote }}
app.kubernetes.io/managed-by: {{ .Release.Service }}
helm.sh/chart: {{ printf "%s-%s" .Chart.Name .Chart.Version }}
{{- end }}

{{- define "meshmend.image" -}}
{{- if .Values.image.digest }}{{ .Values.image.repository }}@{{ .Values.image.digest }}{{ else }}{{ .Values.image.repository }}:{{ .Values.image.tag | default .Chart.AppVersion }}{{ end }}
{{- end }}
